#!/bin/sh
# Prints a Python of the version asked for that can make virtual environments: find_python.sh 3.11
for candidate in "python$1" "${PYENV_ROOT:-$HOME/.pyenv}"/versions/"$1".*/bin/python3 \
    "/usr/local/bin/python$1" "/usr/bin/python$1" python3 python; do
    if "$candidate" -c "import ensurepip, sys, venv; sys.exit('%d.%d' % sys.version_info[:2] != '$1')" \
        2>/dev/null; then
        command -v "$candidate"
        exit 0
    fi
done
