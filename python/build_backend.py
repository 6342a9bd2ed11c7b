"""setuptools as a build backend that needs no network: pip's isolated builds hide the system's packages, where it is."""

import sys
import sysconfig

try:
    import setuptools  # noqa: F401
    import wheel  # noqa: F401
except ImportError:
    # Debian's own, and whatever prefix the interpreter was installed under.
    sys.path += ["/usr/lib/python3/dist-packages", sysconfig.get_path("purelib", vars={"base": sys.base_prefix})]

from setuptools.build_meta import *  # noqa: E402, F401, F403


def get_requires_for_build_wheel(config_settings=None):
    """Nothing to fetch."""
    return []


get_requires_for_build_sdist = get_requires_for_build_editable = get_requires_for_build_wheel
