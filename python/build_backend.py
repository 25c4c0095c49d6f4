"""Builds the Python package with CMake: a PEP 517 backend that needs only packages of Debian 12.

The compiled module is built in build/. scripts/demo and scripts/test use the same folder, so that no file is compiled
twice. If the interpreter is not of the system's version, the module is built in a separate folder.
"""

import base64
import hashlib
import os
import re
import subprocess
import sys
import sysconfig
import tarfile
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
NAME = "ricochet"


def _version():
    text = (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")
    found = re.search(r"project\(ricochet VERSION ([0-9.]+)", text)
    if found is None:
        raise RuntimeError("CMakeLists.txt names no version")
    return found.group(1)


def _abi(executable):
    command = [executable, "-c", "import sysconfig; print(sysconfig.get_config_var('SOABI'))"]
    try:
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return None


def _folder():
    """Returns the build folder, and the path of the interpreter for which the module is built."""
    system = "/usr/bin/python3"
    if _abi(system) == sysconfig.get_config_var("SOABI"):
        return ROOT / "build", system
    return ROOT / "build" / f"python-{sysconfig.get_python_version()}", sys.executable


def _build():
    folder, python = _folder()
    settings = ["-DRICOCHET_BUILD_PYTHON=ON", f"-DPython_EXECUTABLE={python}"]
    if not (folder / "CMakeCache.txt").exists():
        settings.append("-DRICOCHET_BUILD_TESTS=OFF")
    subprocess.run(["cmake", "--preset", "release", "-B", str(folder), *settings], cwd=ROOT, check=True)
    jobs = os.environ.get("CMAKE_BUILD_PARALLEL_LEVEL") or str(os.cpu_count() or 1)
    subprocess.run(
        ["cmake", "--build", str(folder), "--parallel", jobs, "--target", "ricochet_python"], cwd=ROOT, check=True
    )
    return folder / "python" / NAME


def _metadata():
    readme = (ROOT / "docs" / "python.md").read_text(encoding="utf-8")
    return (
        f"Metadata-Version: 2.1\nName: {NAME}\nVersion: {_version()}\n"
        "Summary: Particles against triangle meshes, exactly\nRequires-Python: >=3.9\nRequires-Dist: numpy\n"
        "Provides-Extra: progress\nRequires-Dist: tqdm; extra == 'progress'\n"
        f"Description-Content-Type: text/markdown\n\n{readme}"
    )


def _tag():
    version = f"cp{sys.version_info.major}{sys.version_info.minor}"
    platform = sysconfig.get_platform().replace("-", "_").replace(".", "_")
    return f"{version}-{version}-{platform}"


def _wheel_text():
    return f"Wheel-Version: 1.0\nGenerator: ricochet\nRoot-Is-Purelib: false\nTag: {_tag()}\n"


class _Wheel:
    """A wheel: a zip file with a RECORD of its members."""

    def __init__(self, path):
        self._zip = zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED)
        self._records = []

    def add(self, name, data):
        self._zip.writestr(name, data)
        digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
        self._records.append(f"{name},sha256={digest},{len(data)}")

    def close(self, info):
        self._zip.writestr(f"{info}/RECORD", "\n".join([*self._records, f"{info}/RECORD,,", ""]))
        self._zip.close()


def get_requires_for_build_wheel(config_settings=None):
    return []


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    info = f"{NAME}-{_version()}.dist-info"
    folder = Path(metadata_directory) / info
    folder.mkdir(parents=True)
    (folder / "METADATA").write_text(_metadata(), encoding="utf-8")
    (folder / "WHEEL").write_text(_wheel_text(), encoding="utf-8")
    return info


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    package = _build()
    info = f"{NAME}-{_version()}.dist-info"
    name = f"{NAME}-{_version()}-{_tag()}.whl"
    wheel = _Wheel(Path(wheel_directory) / name)
    for file in sorted(package.iterdir()):
        if file.is_file():
            wheel.add(f"{NAME}/{file.name}", file.read_bytes())
    wheel.add(f"{info}/LICENSE", (ROOT / "LICENSE").read_bytes())
    wheel.add(f"{info}/METADATA", _metadata().encode())
    wheel.add(f"{info}/WHEEL", _wheel_text().encode())
    wheel.close(info)
    return name


def build_sdist(sdist_directory, config_settings=None):
    base = f"{NAME}-{_version()}"
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
    with tarfile.open(Path(sdist_directory) / f"{base}.tar.gz", "w:gz") as archive:
        for file in filter(None, listed.split("\0")):
            archive.add(ROOT / file, f"{base}/{file}", recursive=False)
    return f"{base}.tar.gz"
