"""Time of whole processes, from exec to a new file, by default flags: the command that people run. A Markdown table.

usage: ./dev bench --pictures MODEL.. [--against PROGRAM] [--sizes 64,512,1280x720] [--threads 1,2] [--rounds 11] [--batch] [-- FLAGS]
  --against PROGRAM   another build's program, in turn with this one: ratios of this one to it
  --batch             one process that draws all models, instead of a process a picture
  FLAGS: more flags of 'halflit render', for both

CPU is the processor's time of the process, user and system; wall is from its start to its end. Of each command's rounds the lower
quartile counts, as other work on the machine only adds.
"""

import argparse
import itertools
import math
import os
import pathlib
import sys
import tempfile
import time


def run(command):
    """Milliseconds of the processor, and of the clock."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    start = time.perf_counter()
    process = os.posix_spawn(command[0], command, os.environ, file_actions=[(os.POSIX_SPAWN_DUP2, nowhere, 1), (os.POSIX_SPAWN_DUP2, nowhere, 2)])
    _, status, usage = os.wait4(process, 0)
    wall = time.perf_counter() - start
    os.close(nowhere)
    if status != 0:
        sys.exit(f"pictures: failed: {' '.join(command)}")
    return 1000 * (usage.ru_utime + usage.ru_stime), 1000 * wall


def in_turn(commands, rounds):
    """(cpu, wall) of each command: lower quartiles of rounds in which all run, in changing order."""
    times = [[] for _ in commands]
    for command in commands:
        run(command)  # reads files into the system's cache
    for number in range(rounds):
        order = list(range(len(commands)))
        for k in order if number % 2 == 0 else reversed(order):
            times[k].append(run(commands[k]))
    return [tuple(sorted(values)[len(values) // 4] for values in zip(*rows)) for rows in times]


def size_of(text):
    return text if "x" in text else f"{text}x{text}"


def geometric_mean(values):
    return math.exp(sum(map(math.log, values)) / len(values))


def main():
    arguments, flags = sys.argv[2:], []
    if "--" in arguments:
        at = arguments.index("--")
        arguments, flags = arguments[:at], arguments[at + 1 :]
    parser = argparse.ArgumentParser(prog="./dev bench --pictures", usage=__doc__.split("usage: ")[1])
    parser.add_argument("models", nargs="+")
    parser.add_argument("--against")
    parser.add_argument("--sizes", default="64,512,1280x720")
    parser.add_argument("--threads", default="1,2")
    parser.add_argument("--rounds", type=int, default=11)
    parser.add_argument("--batch", action="store_true")
    options = parser.parse_args(arguments)
    programs = [sys.argv[1]] + ([options.against] if options.against else [])

    jobs = [options.models] if options.batch else [[model] for model in options.models]
    print("| pictures | size | threads | CPU ms | wall ms |" + (" CPU ratio | wall ratio |" if options.against else ""))
    print("|---|---|---|---|---|" + ("---|---|" if options.against else ""))
    for size, threads in itertools.product(options.sizes.split(","), options.threads.split(",")):
        ratios = []
        for job in jobs:
            with tempfile.TemporaryDirectory() as folder:
                out = folder + "/" if len(job) > 1 else f"{folder}/picture.png"
                rest = ["render", *job, "-o", out, "--size", size_of(size), "--threads", threads, *flags]
                results = in_turn([[program, *rest] for program in programs], options.rounds)
            name = pathlib.Path(job[0]).stem if len(job) == 1 else f"{len(job)} in one process"
            row = f"| {name} | {size_of(size)} | {threads} | {results[0][0]:.1f} | {results[0][1]:.1f} |"
            if options.against:
                ratios.append([ours / other for ours, other in zip(*results)])
                row += f" {ratios[-1][0]:.3f} | {ratios[-1][1]:.3f} |"
            print(row, flush=True)
        if options.against and len(ratios) > 1:
            means = [geometric_mean(column) for column in zip(*ratios)]
            print(f"| geometric mean | {size_of(size)} | {threads} | | | {means[0]:.3f} | {means[1]:.3f} |", flush=True)


main()
