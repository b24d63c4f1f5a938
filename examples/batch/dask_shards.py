#!/usr/bin/env python3
"""Runs a batch of orchard over a cluster of Dask, a shard a task, and makes one table of it.

dask_shards.py MESHES OUT [--shards N] [--scheduler ADDRESS] [--workers N] [--orchard PROGRAM] -- build OPTIONS

MESHES is a folder or a manifest, OUT a folder that all workers see. Without --scheduler a cluster of processes is started on
this machine; with it (tcp://host:8786) the tasks go to the workers of that scheduler, which need orchard at the same path.
A worker that dies costs nothing: Dask gives its shard to another one, and --resume runs what is missing of it.
"""
import argparse
import os
import signal
import subprocess
import sys

from distributed import Client, LocalCluster, as_completed


def run_shard(program, meshes, out, index, count, command):
    """One task: what orchard printed of a shard. Meshes that fail have a row; what fails here is the machine's fault."""
    done = subprocess.run([program, "batch", meshes, "-o", out, "--shard", f"{index}/{count}", "--jobs", "1", "--resume",
                           "--", *command], capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(f"shard {index}/{count}: {done.stderr.strip()}")
    return done.stdout.strip()


def connect(arguments):
    if arguments.scheduler:
        return Client(arguments.scheduler)
    cluster = LocalCluster(n_workers=arguments.workers, threads_per_worker=1, processes=True, dashboard_address=None)
    return Client(cluster)


def kill_a_worker(client):
    """As a machine that goes away would."""
    pid = next(iter(client.run(os.getpid).values()))
    print(f"killing the worker with process id {pid}")
    os.kill(pid, signal.SIGKILL)


def main():
    words = sys.argv[1:]
    own, command = (words[:words.index("--")], words[words.index("--") + 1:]) if "--" in words else (words, [])
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("meshes")
    parser.add_argument("out")
    parser.add_argument("--shards", type=int, default=8, help="more of them than workers, so that none waits long")
    parser.add_argument("--scheduler", help="the address of one that runs already")
    parser.add_argument("--workers", type=int, default=2, help="of the cluster on this machine")
    parser.add_argument("--orchard", default="orchard", help="the program")
    parser.add_argument("--kill-one", action="store_true", help="kill a worker when the first shard is done, to see what happens")
    arguments = parser.parse_args(own)
    if not command:
        parser.error("say what to do with every mesh behind --, such as -- build --depth 2")
    meshes, out = os.path.abspath(arguments.meshes), os.path.abspath(arguments.out)
    with connect(arguments) as client:
        tasks = [client.submit(run_shard, arguments.orchard, meshes, out, index, arguments.shards, command, retries=2, pure=False)
                 for index in range(1, arguments.shards + 1)]
        for count, task in enumerate(as_completed(tasks), 1):
            print(task.result())
            if count == 1 and arguments.kill_one:
                kill_a_worker(client)
    sys.exit(subprocess.run([arguments.orchard, "batch", "merge", out, "-o", os.path.join(out, "table")]).returncode)


if __name__ == "__main__":
    main()
