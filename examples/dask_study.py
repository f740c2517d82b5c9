#!/usr/bin/env python3
"""A study's shards on a dask.distributed cluster: a cloud, a lab's workstations, or some processes of this machine.

    pip install 'pirsim[dask]'
    python dask_study.py --scene meeting_room.gltf --script studyA.yaml -o rows.csv
    python dask_study.py --scheduler tcp://head:8786 --shards 500 --scene room.gltf --script study.yaml -o rows.csv

The rows are the bytes that one process writes. Called again after it was stopped, it simulates what is missing.
"""
import argparse

from distributed import Client, LocalCluster

import pirsim.dask


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scene", required=True, help="glTF file, at the same path on all workers")
    parser.add_argument("--script", required=True, help="YAML file, at the same path on all workers")
    parser.add_argument("-o", "--output", required=True, help="rows, .csv, .csv.gz or .csv.zst")
    parser.add_argument("--shards", type=int, default=24, help="some for each core of the cluster (default: 24)")
    parser.add_argument("--scheduler", help="address of a running cluster (default: processes of this machine)")
    parser.add_argument("--command", default="", help="how pirsim is called, if not as the package's own")
    options, others = parser.parse_known_args()
    cluster = options.scheduler or LocalCluster(threads_per_worker=1, dashboard_address=None)
    with Client(cluster) as client:
        pirsim.dask.run_study(client, options.scene, options.script, options.output, shards=options.shards,
                              arguments=others, command=options.command.split(),
                              progress=lambda there, shards: print(f"{there} of {shards} shards", flush=True))


if __name__ == "__main__":
    main()
