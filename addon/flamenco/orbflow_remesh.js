// SPDX-License-Identifier: GPL-3.0-or-later
//
// A job type of Flamenco: remeshes every file of a folder, a task for each.
//
// Copy it into the folder `scripts` beside the `flamenco-manager` program. Workers need the program
// `orbflow` for meshes (OBJ, PLY, STL, OFF, GLB, glTF), and Blender with the Orbflow extension for
// .blend files, in which every visible mesh is remeshed with all that the artist has left on it.
// Files that a worker cannot do fail alone: the others of the job go on.

const JOB_TYPE = {
    label: "Orbflow Remesh",
    description: "Rebuild every mesh of a folder with good edge flow",
    settings: [
        { key: "source", type: "string", subtype: "dir_path", required: true, visible: "submission",
          description: "The folder of .blend files and meshes" },
        { key: "target", type: "string", subtype: "dir_path", required: true, visible: "submission",
          description: "The folder of results; files of the same name there are replaced" },
        { key: "files", type: "string", required: true,
          eval: "'; '.join(sorted(p.name for p in abspath(settings.source).iterdir() if p.suffix.lower() in {'.blend', '.obj', '.ply', '.stl', '.off', '.glb', '.gltf'}))",
          evalInfo: {
              showLinkButton: true,
              description: "All that can be remeshed in the folder",
          },
          description: "Names of files in the folder, with semicolons between" },
        { key: "faces", type: "int32", default: 2000, propargs: { min: 4, max: 4000000 },
          description: "How many faces each mesh gets" },
        { key: "kind", type: "string", choices: ["QUADS", "TRIANGLES"], default: "QUADS",
          description: "What the faces are" },
        { key: "mirror", type: "string", choices: ["OFF", "AUTO", "X", "Y", "Z"], default: "AUTO",
          description: "Across which axis quads are their own image" },
        { key: "chunk_size", type: "int32", default: 1, propargs: { min: 1, max: 1000 },
          visible: "submission", description: "How many files a task does" },
        { key: "options", type: "string", default: "", visible: "submission",
          description: "More options of `orbflow remesh`; .blend files do not heed them" },
        { key: "program", type: "string", default: "orbflow", visible: "submission",
          description: "The program, its path, or a variable of the manager such as {orbflow}" },
    ]
};

// Of meshes, by the ending of the file: that of the result.
const RESULTS = {
    obj: "obj", ply: "ply", stl: "obj", off: "off", glb: "glb", gltf: "gltf", blend: "blend",
};

function compileJob(job) {
    const settings = job.settings;
    const files = filesOf(settings);

    const folder = author.Task("folder", "file-management");
    folder.addCommand(author.Command("make-directory", { path: settings.target }));
    job.addTask(folder);

    for (const chunk of chunksOf(files, settings.chunk_size)) {
        const task = author.Task(nameOf(chunk), typeOf(chunk));
        for (const file of chunk) {
            task.addCommand(commandFor(file, settings));
        }
        task.addDependency(folder);
        job.addTask(task);
    }
}

// The files, each with its ending and the name of its result. Two with one result are refused.
function filesOf(settings) {
    const names = settings.files.split(";").map(name => name.trim()).filter(name => name);
    if (names.length === 0) {
        throw "there are no files to remesh";
    }
    const taken = {};
    return names.map(name => {
        const ending = name.slice(name.lastIndexOf(".") + 1).toLowerCase();
        if (!Object.prototype.hasOwnProperty.call(RESULTS, ending)) {
            throw `"${name}" is no file that can be remeshed`;
        }
        const result = `${path.stem(name)}.${RESULTS[ending]}`;
        if (Object.prototype.hasOwnProperty.call(taken, result)) {
            throw `"${taken[result]}" and "${name}" would both become "${result}"`;
        }
        taken[result] = name;
        return { name: name, result: result, isBlend: ending === "blend" };
    });
}

// Files that follow each other and need the same program, at most so many together.
function chunksOf(files, size) {
    if (!(size >= 1)) {
        throw `a task does at least one file, not ${size}`;
    }
    const chunks = [];
    for (const file of files) {
        const last = chunks[chunks.length - 1];
        if (last && last.length < size && last[0].isBlend === file.isBlend) {
            last.push(file);
        } else {
            chunks.push([file]);
        }
    }
    return chunks;
}

function nameOf(chunk) {
    const more = chunk.length > 1 ? ` and ${chunk.length - 1} more` : "";
    return `remesh ${chunk[0].name}${more}`;
}

// Workers say which types of task they do.
function typeOf(chunk) {
    return chunk[0].isBlend ? "blender" : "misc";
}

function commandFor(file, settings) {
    const source = path.join(settings.source, file.name);
    const result = path.join(settings.target, file.result);
    return file.isBlend ? blenderFor(source, result, settings)
                        : programFor(source, result, settings);
}

function programFor(source, result, settings) {
    return author.Command("exec", {
        exe: settings.program,
        args: [
            "remesh", source, result,
            "--faces", `${settings.faces}`,
            "--kind", settings.kind.toLowerCase(),
            "--mirror", settings.mirror.toLowerCase(),
            "--report", `${result}.json`,
        ].concat(settings.options ? shellSplit(settings.options) : []),
    });
}

function blenderFor(source, result, settings) {
    return author.Command("blender-render", {
        exe: "{blender}",
        exeArgs: "{blenderArgs}",
        // Without a code Blender ends well whatever Python says.
        argsBefore: ["--python-exit-code", "1"],
        blendfile: source,
        args: ["--python-expr", scriptFor(result, settings)],
    });
}

// What Blender does with an open file. Strings of JSON are strings of Python.
function scriptFor(result, settings) {
    const wanted = [
        `faces=${settings.faces}`,
        `kind=${JSON.stringify(settings.kind)}`,
        `mirror=${JSON.stringify(settings.mirror)}`,
    ].join(", ");
    return [
        "import bpy",
        "view_layer = bpy.context.view_layer",
        "if bpy.context.mode != 'OBJECT': bpy.ops.object.mode_set(mode='OBJECT')",
        "for each in view_layer.objects: each.select_set(each.type == 'MESH' and each.visible_get())",
        `assert bpy.ops.object.orbflow_remesh(${wanted}) == {'FINISHED'}`,
        `bpy.ops.wm.save_as_mainfile(filepath=${JSON.stringify(result)}, copy=True)`,
    ].join("\n");
}
