"""What all drivers share: jobs come as JSON lines on standard input, one JSON reply a line goes out.

A job is {"scene": path, "samples": n, "seed": n, "threads": n, "mode": "measure" or "shipped", "out": path}. The reply is
{"out": path, "seconds": s}, {"unsupported": "why"} or {"error": "what"}. Import this module before the program's own, and after
`shapes`: it moves standard output to standard error, so that nothing that a library prints can come between the replies, and
takes the drivers' folder off the search path, so that `import mitsuba` finds Mitsuba and not the driver of that name.
"""

import json
import os
import subprocess
import sys
import time
import traceback
from pathlib import Path

REPLIES = os.fdopen(os.dup(1), "w", buffering=1)  # where replies go: a copy of standard output, flushed at each line
os.dup2(2, 1)  # whatever else is printed goes to standard error
sys.path = [path for path in sys.path if Path(path).resolve() != Path(__file__).resolve().parent]


class Unsupported(Exception):
    """The program, or its driver, cannot answer this question; says why in one sentence."""


def unknown(what, item):
    """That there is no way to express an item of this kind."""
    return Unsupported(f"the {what} {item['kind']} is not known")


def run(*command, **settings):
    """What a program writes to standard output; if it fails, an error with the end of what it says."""
    done = subprocess.run([*map(str, command)], capture_output=True, **settings)
    if done.returncode:
        raise RuntimeError(f"{command[0]} ends with {done.returncode}: {done.stderr.decode(errors='replace')[-500:]}")
    return done.stdout


def write_picture(path, picture):
    """Writes an array of rows, the top one first, of grey or of red, green and blue, as a portable float map."""
    height, width = picture.shape[:2]
    kind = "Pf" if picture.ndim == 2 else "PF"
    with open(path, "wb") as file:  # the bottom row comes first; -1 says little-endian
        file.write(f"{kind}\n{width} {height}\n-1.0\n".encode() + picture[::-1].astype("<f4").tobytes())


def answer(job, render):
    """Renders one job by `render(scene, job)`, which writes job["out"], and returns the reply."""
    start = time.perf_counter()
    try:
        with open(job["scene"], encoding="utf-8") as file:
            scene = json.load(file)
        if scene["version"] != 1:
            raise Unsupported(f"version {scene['version']} of the scene format is not known")
        render(scene, job)
    except Unsupported as why:
        return {"unsupported": str(why)}
    except Exception as fault:  # one broken job must not end the batch
        traceback.print_exc()
        return {"error": f"{type(fault).__name__}: {fault}"}
    return {"out": job["out"], "seconds": round(time.perf_counter() - start, 4)}


def serve(version, render):
    """Prints `version()` if asked for it by --version, else answers jobs until there are no more."""
    if "--version" in sys.argv[1:]:
        print(version(), file=REPLIES)
        return
    for line in sys.stdin:
        if line.strip():
            print(json.dumps(answer(json.loads(line), render)), file=REPLIES)
