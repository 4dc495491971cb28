"""Options that several words of the command line share, so that they mean the same everywhere."""

from __future__ import annotations

from pathlib import Path

import click

design_argument = click.argument("design")

set_option = click.option(
    "--set",
    "overrides",
    multiple=True,
    metavar="KEY=VALUE",
    help="Override a value of the design file; dotted keys as in the file, repeatable.",
)

json_option = click.option("--json", "as_json", is_flag=True, help="Write JSON to stdout, errors too.")

mechanisms_option = click.option(
    "--mechanisms",
    multiple=True,
    type=click.Path(path_type=Path),
    metavar="FILE.py",
    envvar="LINKWRIGHT_MECHANISMS",
    show_envvar=True,
    help="Python file (or folder) with mechanisms of your own, its ENTRIES; repeatable. It is run.",
)

debug_option = click.option("--debug", is_flag=True, expose_value=False, help="Show the traceback of an error.")

strict_option = click.option("--strict", is_flag=True, help="Count warnings as failures.")

seed_option = click.option("--seed", type=click.IntRange(min=0), help="Seed of the sampled poses (sampling.seed).")

poses_option = click.option("--poses", type=click.IntRange(min=1), help="How many poses to visit (sampling.n_poses).")

output_file_option = click.option(
    "-o",
    "--output",
    type=click.Path(dir_okay=False, path_type=Path),
    help="File to write instead of stdout.",
)


def sampling_overrides(overrides: tuple[str, ...], seed: int | None, poses: int | None) -> list[str]:
    """The `--set` texts with --seed and --poses among them; these two come last and hold."""
    texts = list(overrides)
    texts += [f"sampling.seed={seed}"] if seed is not None else []
    texts += [f"sampling.n_poses={poses}"] if poses is not None else []
    return texts
