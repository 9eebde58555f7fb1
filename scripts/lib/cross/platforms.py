# SPDX-License-Identifier: MIT OR Apache-2.0
"""The platforms: how their programs are linked and run here, and what their wheels look like."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Mapping


@dataclass(frozen=True)
class Platform:
    """A platform, by what the compiler, Debian's other tools and Python call it."""

    what: str
    triple: str
    """The compiler's name."""
    tools: str
    """What the names of its compiler for C, and of its tools for object files, begin with."""
    runner: str
    """The command that runs its programs here."""
    wheel: str
    """What the name of its wheel ends with."""
    libraries: str
    """A pattern: the libraries that a wheel may load, which everybody has."""
    slow_tests: tuple[str, ...] = ()
    """Words in the names of tests that are left out because the runner needs too long for them."""

    @property
    def variables(self) -> Mapping[str, str]:
        """What cargo and the crates with C sources need to know."""
        name = self.triple.replace("-", "_")
        linker = f"{self.tools}gcc"
        return {
            f"CARGO_TARGET_{name.upper()}_LINKER": linker,
            f"CARGO_TARGET_{name.upper()}_RUNNER": self.runner,
            f"CC_{name}": linker,
            f"AR_{name}": f"{self.tools}ar",
        }

    def strange_libraries(self, names: list[str]) -> list[str]:
        """Those of the names that a wheel must not load."""
        return [name for name in names if not re.fullmatch(self.libraries, name, re.IGNORECASE)]


PLATFORMS = {
    "windows-x64": Platform(
        what="Windows on x86-64, by wine",
        triple="x86_64-pc-windows-gnu",
        tools="x86_64-w64-mingw32-",
        runner="wine",
        wheel="win_amd64",
        # Python's stable interface and what every Windows has; not libgcc or libwinpthread.
        libraries=r"(python3|kernel32|ntdll|bcryptprimitives|msvcrt|ucrtbase|userenv|ws2_32|api-ms-win-[\w-]+)\.dll",
    ),
    "linux-arm64": Platform(
        what="Linux on ARM, by qemu",
        triple="aarch64-unknown-linux-gnu",
        tools="aarch64-linux-gnu-",
        runner="qemu-aarch64 -L /usr/aarch64-linux-gnu",
        wheel="linux_aarch64",
        libraries=r"(libc|libm|libgcc_s|ld-linux-aarch64)\.so\.\d",
        # Each takes 7 s to 2 minutes on two cores, and twenty times as long by qemu.
        slow_tests=(
            "every_processor_finds_the_same_map",
            "a_factorization_can_be_cancelled_and_done_again",
            "solves_grids_with_none_one_and_two_unknowns_at_a_vertex",
            "solves_closed_meshes_fans_and_parts_that_do_not_touch",
            "a_symmetric_surface_has_an_exactly_symmetric_proxy",
            "a_run_cancelled_at_any_report_returns_a_sound_map",
            "random_surfaces_are_mapped_one_to_one",
            "capsules_of_any_length_are_mapped_one_to_one",
            "thin_horns_are_mapped_one_to_one",
            "symmetric_surfaces_are_no_less_exact_than_by_the_papers_methods",
            "targets_seven_orders_of_magnitude_apart_are_mapped_one_to_one",
            "spheres_are_a_hundred_times_as_exact_as_by_gradient_descent",
            "start_maps_of_disks_are_improved_and_folded_ones_unfolded",
        ),
    ),
}
"""By Blender's names."""
NATIVE = "x86_64-unknown-linux-gnu"
"""The compiler's name of this machine, the only one that can do this."""
