// Stands for the manager of Flamenco: compiles the job of a script and prints what it authored.
// The names are those of its documentation and of `internal/manager/job_compilers` in its source.
const fs = require("fs");
const vm = require("vm");

const [script, given] = process.argv.slice(2);

class Command {
    constructor(name, parameters) {
        Object.assign(this, { name, parameters });
    }
}

class Task {
    constructor(name, type) {
        if (!name.trim() || !type.trim()) {
            throw "author.Task(name, type): both are required";
        }
        Object.assign(this, { name, type, commands: [], dependencies: [] });
    }
    addCommand(command) {
        this.commands.push(command);
    }
    addDependency(task) {
        this.dependencies.push(task.name);
    }
}

// On all platforms the manager takes both slashes.
const parts = name => name.split(/[\\/]/);
const path = {
    join: (...all) => all.join("/").replace(/\/+/g, "/"),
    basename: name => parts(name).pop(),
    dirname: name => parts(name).slice(0, -1).join("/"),
    stem: name => parts(name).pop().replace(/\.[^.]*$/, ""),
};
const author = {
    Task: (name, type) => new Task(name, type),
    Command: (name, parameters) => new Command(name, parameters),
};
const shellSplit = text => text.split(/\s+/).filter(part => part);

const context = vm.createContext({ author, path, shellSplit, print: () => undefined });
vm.runInContext(fs.readFileSync(script, "utf8"), context);
const type = vm.runInContext("JOB_TYPE", context);
const tasks = [];
let error = null;
if (given) {
    const job = { settings: JSON.parse(given), addTask: task => tasks.push(task) };
    try {
        vm.runInContext("compileJob", context)(job);
    } catch (thrown) {
        error = `${thrown}`;
    }
}
console.log(JSON.stringify({ type, tasks, error }));
