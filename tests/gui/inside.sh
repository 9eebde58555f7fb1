#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs inside the Debian system, in the folder of the test: installs the extension and starts Blender on a virtual screen.
set -eu
here=$PWD
export HOME=$here/home XDG_RUNTIME_DIR=$here/run LIBGL_ALWAYS_SOFTWARE=1 AUTHALIC_GUI_OUT=$here PYTHONPATH=$here
mkdir -p home run
chmod 700 run
blender --command extension install-file -r user_default -e extension.zip
Xvfb -displayfd 3 -screen 0 1280x800x24 +extension GLX 3> display > xvfb.log 2>&1 &
trap "kill $!" EXIT
until [ -s display ]; do sleep 0.1; done
DISPLAY=:$(cat display) timeout "$1" blender --factory-startup --window-geometry 0 0 1280 800 \
  --addons bl_ext.user_default.authalic --enable-event-simulate --python-use-system-env --python start.py
