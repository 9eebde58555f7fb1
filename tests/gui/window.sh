#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs a script in a real Blender window on a screen that nobody sees: window.sh SCRIPT.py [FOLDER]
# See README.md beside this file.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
script=$1
out=${2:-$root/out/gui}
zip=${AUTHALIC_EXTENSION_ZIP:-$(ls -t "$root"/dist/authalic-*-linux-x64.zip | head -1)}
system=${AUTHALIC_GUI_SYSTEM:-$HOME/.cache/authalic/chroot-trixie}
display=:${AUTHALIC_GUI_DISPLAY:-93}

if [ ! -x "$system/usr/bin/blender" ]; then
  mkdir -p "${system%/*}"
  apt-get install -y -qq mmdebstrap
  mmdebstrap --variant=minbase --skip=check/empty --aptopt='Apt::Install-Recommends "false"' \
    --include=blender,python3-numpy,xvfb,xauth,imagemagick,libgl1-mesa-dri,libegl1,libglx-mesa0,fonts-dejavu-core \
    --keyring=/usr/share/keyrings/debian-archive-keyring.gpg trixie "$system"
fi

inside=/tmp/authalic-gui
work=$system$inside
rm -rf "$work"
mkdir -p "$work/home" "$work/run" "$out"
chmod 700 "$work/run"
cp "$zip" "$work/extension.zip"
cp "$here"/*.py "$work/"
cat > "$work/inside.sh" <<INSIDE
cd $inside
export HOME=$inside/home XDG_RUNTIME_DIR=$inside/run LIBGL_ALWAYS_SOFTWARE=1 AUTHALIC_GUI_OUT=$inside PYTHONPATH=$inside
blender --command extension install-file -r user_default -e extension.zip
Xvfb $display -screen 0 1280x800x24 +extension GLX > xvfb.log 2>&1 & screen=\$!
trap "kill \$screen" EXIT
sleep 1
DISPLAY=$display timeout 400 blender --factory-startup --window-geometry 0 0 1280 800 \
  --addons bl_ext.user_default.authalic --enable-event-simulate --python-use-system-env \
  --python $(basename "$script")
INSIDE
chroot "$system" bash "$inside/inside.sh" > "$work/blender.log" 2>&1 || true
cp "$work"/*.png "$work"/*.log "$out/" 2> /dev/null || true
cat "$out/checks.log"
tail -1 "$out/checks.log" | grep -q '^PASSED'
