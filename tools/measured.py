"""What scripts share that measure for a page: programs and their processor time, what was measured, parts of the page."""
import json
import os
import pathlib
import platform
import resource
import subprocess
import tempfile
import typing

ROOT = pathlib.Path(__file__).resolve().parent.parent
IMAGES = ROOT / "docs/images"


def run(command):
    """What the program prints. An error says what it said, beside its command."""
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f"exit code {done.returncode}: {' '.join(map(str, command))}\n{done.stderr.strip()}")
    return done.stdout


def seconds_of_children():
    """Processor time that programs have taken so far, those that have ended: differences of it are a program's."""
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime


class Measured(typing.NamedTuple):
    """What a program took: processor time of its own code in seconds, largest resident memory in MiB, and its exit code."""
    seconds: float
    mebibytes: float
    code: int


def run_measured(command, accepted=(0,)):
    """Runs the program without its output. An exit code that is not accepted is an error, which says what the program said."""
    with tempfile.TemporaryFile() as said:
        child = subprocess.Popen([str(part) for part in command], stdout=subprocess.DEVNULL, stderr=said)
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
        if child.returncode not in accepted:
            said.seek(0)
            raise SystemExit(f"exit code {child.returncode}: {' '.join(map(str, command))}\n{said.read().decode(errors='replace').strip()}")
    return Measured(usage.ru_utime, usage.ru_maxrss / 1024, child.returncode)


def processor():
    """The name of this machine's processor."""
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return platform.machine()


def kept(file, empty):
    return json.loads(file.read_text(encoding="utf-8")) if file.exists() else empty


def keep(file, data, **style):
    """Replaces the file in one step, so that what was measured before is never half there."""
    new = file.with_name(file.name + ".new")
    new.write_text(json.dumps(data, **({"indent": 1} | style)) + "\n", encoding="utf-8")
    os.replace(new, file)


def write_parts(page, parts):
    """Puts each text between the page's marks "<!-- begin: NAME -->" and "<!-- end"; what is around them stays."""
    text = page.read_text(encoding="utf-8")
    for name, part in parts.items():
        mark = f"<!-- begin: {name} -->\n"
        begin = text.find(mark) + len(mark)
        end = text.find("<!-- end", begin)
        if begin < len(mark) or end < 0:
            raise SystemExit(f"{page.name} has no part '{name}'")
        text = text[:begin] + part.rstrip("\n") + "\n" + text[end:]
    page.write_text(text, encoding="utf-8")


def draw_charts(program, plots, columns, picture):
    """Plots as orchard-chart takes them, which is beside the program, as an SVG."""
    charts = picture.with_suffix(".json.new")
    charts.write_text(json.dumps({"columns": columns, "plots": plots}), encoding="utf-8")
    try:
        run([pathlib.Path(program).resolve().parent / "plot/orchard-chart", charts, picture])
    finally:
        charts.unlink()
