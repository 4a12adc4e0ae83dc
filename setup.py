from pathlib import Path

from setuptools import find_packages, setup

package = "sfd_hbm_ros"


def files(folder: str, pattern: str) -> tuple[str, list[str]]:
    """One entry of data_files: what the package's share folder gets of a folder."""
    return f"share/{package}/{folder}", sorted(str(path) for path in Path(folder).glob(pattern))


setup(
    name=package,
    version="0.1.0",
    packages=find_packages(include=[package, f"{package}.*"]),
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{package}"]),
        (f"share/{package}", ["package.xml"]),
        files("config", "*.yaml"),
        files("launch", "*.launch.*"),
        files("sros2", "*.xml"),
    ],
    python_requires=">=3.11",
    install_requires=["numba", "numpy", "scipy", "pyyaml", "matplotlib"],
    extras_require={"test": ["pytest"], "study": ["distributed", "pyarrow"]},
    zip_safe=True,
    maintainer="sfd_hbm_ros maintainers",
    maintainer_email="maintainers@sfd-hbm-ros.org",
    description="Live harmonic-balance predictions for rotors on squeeze film dampers",
    license="Apache-2.0",
    entry_points={
        "console_scripts": [
            f"predictor = {package}.node.predictor:main",
            f"simulator = {package}.node.simulator.simulator:main",
            f"supervisor = {package}.node.supervisor:main",
            f"sfd_hbm = {package}.cli:main",
        ],
    },
)
