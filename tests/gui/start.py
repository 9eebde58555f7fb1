# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the scripts that AUTHALIC_GUI_SCRIPTS names in a window; see README.md beside this file."""

import importlib
import os

import driver

driver.run({name: importlib.import_module(name).STEPS for name in os.environ["AUTHALIC_GUI_SCRIPTS"].split()})
