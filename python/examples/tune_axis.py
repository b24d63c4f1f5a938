"""Tunes a medial axis: builds it with several border losses, and plots its error against its size."""
import argparse
import pathlib

import matplotlib.pyplot as pyplot

import orchard_geometry as og

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("--data", type=pathlib.Path, default=pathlib.Path("data"))
parser.add_argument("--output", type=pathlib.Path, default=pathlib.Path("out"))
parser.add_argument("--quick", action="store_true", help="fewer points")
arguments = parser.parse_args()
arguments.output.mkdir(parents=True, exist_ok=True)

mesh = og.load(arguments.data / "faucet.obj")
samples = 800 if arguments.quick else 5000
losses = (0.1, 0.4) if arguments.quick else (0.05, 0.1, 0.2, 0.4, 0.8)
rows = []
for border_loss in losses:
    axis = og.medial_axis(mesh, samples=samples, border_loss=border_loss)
    quality = axis.quality(samples=2000 if arguments.quick else 20_000)
    rows.append((border_loss, len(axis), quality["hausdorff_max"], quality["border_length"]))
    print("border_loss {:5g}: {:6} balls, off by {:.3f} % of the diagonal, borders of {:.1f} diagonals".format(*rows[-1]))

figure, axes = pyplot.subplots(figsize=(6, 4))
axes.plot([row[3] for row in rows], [row[2] for row in rows], "o-")
for border_loss, _, error, length in rows:
    axes.annotate(f"{border_loss:g}", (length, error), textcoords="offset points", xytext=(6, 6))
axes.set_xlabel("length of the borders, in diagonals")
axes.set_ylabel("Hausdorff distance, % of the diagonal")
axes.set_title("faucet: what a border loss buys")
axes.set_ylim(bottom=0)
figure.tight_layout()
figure.savefig(arguments.output / "tune_axis.png", dpi=120)
