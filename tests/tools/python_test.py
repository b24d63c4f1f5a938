"""Every Python script of the project can be parsed, also those that only run for hours by hand.

python_test.py SOURCE
"""
import ast
import pathlib
import sys

FOLDERS = ["apps", "bench", "docs", "examples", "python", "tests", "tools", "viz"]
faults, scripts = [], 0
for folder in FOLDERS:
    for file in sorted((pathlib.Path(sys.argv[1]) / folder).rglob("*")):
        if not file.is_file() or file.suffix not in ("", ".py"):
            continue
        text = file.read_bytes()
        if file.suffix == "" and not (text.startswith(b"#!") and b"python" in text.split(b"\n", 1)[0]):
            continue
        scripts += 1
        try:
            ast.parse(text, file)
        except SyntaxError as error:
            faults.append(f"{file}: line {error.lineno}: {error.msg}")
print("\n".join(faults) or f"{scripts} scripts are valid")
sys.exit(1 if faults or scripts == 0 else 0)
