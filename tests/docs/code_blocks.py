#!/usr/bin/env python3
"""Makes a source file of a page's C++ blocks, so that a compiler can say whether they are right.

code_blocks.py PAGE.md PRELUDE.h OUT.cpp

Each ```cpp block becomes a function of its own; its lines with #include stand before all of them, after the prelude, which
declares what the page leaves to the reader. A block with a main() stands by itself. Fails if the page has no block.
"""
import pathlib
import re
import sys


def blocks(text):
    """Line number and lines of each."""
    block = None
    for number, line in enumerate(text.splitlines(), 1):
        if line.startswith("```"):
            if block is not None:
                yield block
                block = None
            elif line.strip() == "```cpp":
                block = (number + 1, [])
        elif block is not None:
            block[1].append(line)


def main():
    page, prelude, out = (pathlib.Path(argument) for argument in sys.argv[1:])
    found = list(blocks(page.read_text(encoding="utf-8")))
    assert found, f"{page} has no block of C++"
    includes, bodies = [], []
    for number, lines in found:
        includes += [line for line in lines if line.startswith("#include")]
        body = "\n".join("" if line.startswith("#include") else line for line in lines)
        where = f'#line {number} "{page}"\n'
        if re.search(r"\bint main\(", body):
            bodies.append(where + body)
        else:
            bodies.append(f"int block_{number}() {{\n{where}{body}\nreturn 0;\n}}")
    text = "\n".join(includes) + f'\n#include "{prelude.resolve()}"\n' + "\n".join(bodies) + "\n"
    out.write_text(text, encoding="utf-8")


main()
