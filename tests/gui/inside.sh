#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs inside the Debian system, in the folder of the test: installs the extension and starts Blender on a virtual screen.
# Ends with 77 where Blender cannot open a window, whatever the extension.
set -eu
here=$PWD
export HOME=$here/home XDG_RUNTIME_DIR=$here/run LIBGL_ALWAYS_SOFTWARE=1 AUTHALIC_GUI_OUT=$here PYTHONPATH=$here
mkdir -p home run
chmod 700 run
Xvfb -displayfd 3 -screen 0 1280x800x24 +extension GLX 3> display > xvfb.log 2>&1 &
trap "kill $!" EXIT
for _ in {1..300}; do [ -s display ] && break; sleep 0.1; done
[ -s display ] || exit 77
DISPLAY=:$(cat display)
export DISPLAY
quit="import bpy; bpy.app.timers.register(bpy.ops.wm.quit_blender, first_interval=0.1)"
timeout 180 blender --factory-startup --python-exit-code 1 --python-expr "$quit" || exit 77
blender --command extension install-file -r user_default -e extension.zip
timeout "$1" blender --factory-startup --window-geometry 0 0 1280 800 \
  --addons bl_ext.user_default.authalic --enable-event-simulate --python-use-system-env --python start.py
