"""Instructions of small frames, counted by callgrind and compared with the committed numbers.

usage: speed_floor.py PROGRAM COUNTS FOLDER

Times on a machine that others use vary by more than a loss that should be seen, and ratios of times differ from processor to processor.
Instructions are the same in every run, as long as compiler and flags are. They do not show a loss by latency or memory.

A count may be 8 % above the committed number and 10 % below: together that is 20 %, the most that can be lost unseen. A count outside is an
error in both directions, because a number that is too high would hide a later loss. HALFLIT_UPDATE_SPEED=1 writes the numbers anew.
Exit code: 0 within, 1 outside, 4 skipped.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys

MOST, LEAST = 1.08, 0.90


def counted(program, folder):
    """Instructions by name of frame."""
    folder.mkdir(parents=True, exist_ok=True)
    for old in folder.glob("callgrind.*"):
        old.unlink()
    valgrind = ["valgrind", "--tool=callgrind", "--instr-atstart=no", f"--callgrind-out-file={folder}/callgrind.out"]
    run = subprocess.run(valgrind + [program], capture_output=True, text=True)
    if run.returncode == 4:
        print(run.stdout.strip())
        sys.exit(4)
    if run.returncode != 0:
        sys.exit(f"{run.stdout}{run.stderr}\nspeed floor: the program failed")
    counts = {}
    for dump in folder.glob("callgrind.out*"):
        text = dump.read_text()
        name = re.search(r"^desc: Trigger: Client Request: (\S+)$", text, re.M)
        total = re.search(r"^(?:totals|summary): (\d+)", text, re.M)
        if name and total:
            counts[name.group(1)] = int(total.group(1))
    return counts


def main():
    program, file, folder = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
    if shutil.which("valgrind") is None:
        print("skipped: no valgrind")
        sys.exit(4)
    counts = counted(program, folder)
    if not counts:
        sys.exit("speed floor: nothing was counted")
    if os.environ.get("HALFLIT_UPDATE_SPEED") == "1":
        file.write_text("".join(f"{name} {count}\n" for name, count in sorted(counts.items())))
        return
    committed = {name: int(count) for name, count in (line.split() for line in file.read_text().splitlines())}
    if set(committed) != set(counts):
        sys.exit(f"speed floor: frames differ from those of {file}: {sorted(set(committed) ^ set(counts))}")
    good = True
    for name, count in sorted(counts.items()):
        ratio = count / committed[name]
        verdict = "slower" if ratio > MOST else "faster: write the numbers anew" if ratio < LEAST else ""
        print(f"{name:28} {count:12} {ratio:8.3f} {verdict}")
        good = good and not verdict
    if not good:
        sys.exit(f"speed floor: outside {LEAST} .. {MOST} of {file}; HALFLIT_UPDATE_SPEED=1 writes it anew")


main()
