# SPDX-License-Identifier: MIT OR Apache-2.0
"""Runs inside Blender (bpy): installs an extension zip into the current profile and enables it for good.

Usage: BLENDER_USER_RESOURCES=PROFILE python install_in_blender.py ZIP
"""

import os
import sys

import bpy


def install(archive: str) -> None:
    """Installs and enables the extension as a person would, and saves the preferences."""
    bpy.ops.extensions.package_install_files(
        filepath=os.path.abspath(archive), repo="user_default", enable_on_install=True
    )
    if "bl_ext.user_default.authalic" not in bpy.context.preferences.addons:
        raise SystemExit(f"{archive} was installed but could not be enabled")
    bpy.ops.wm.save_userpref()


if __name__ == "__main__":
    status = 0
    try:
        install(sys.argv[1])
    except (RuntimeError, SystemExit) as problem:
        print(problem)
        status = 1
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(status)  # some versions hang at a normal exit
