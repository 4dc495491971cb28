"""Compute the package list: every folder below the five storeys is installed as `linkwright.<folder>`.

All else stands in pyproject.toml; a static list there would have to be edited for each new sub-package.
"""

from setuptools import find_packages, setup

STOREYS = ("app", "designs", "generator", "analysis", "exports")

setup(
    packages=[
        f"linkwright.{name}" for storey in STOREYS for name in find_packages(".", include=[storey, f"{storey}.*"])
    ],
    package_dir={f"linkwright.{storey}": storey for storey in STOREYS},
)
