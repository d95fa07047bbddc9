"""The figures of the page, by section."""
from .drawing import drawing_section
from .meshers import meshers_section
from .network import network_section
from .thesis import thesis_section
from .voxels import voxels_section
from .worlds import worlds_section


def all_sections(evidence):
    return [
        meshers_section(evidence),
        thesis_section(evidence),
        drawing_section(evidence),
        worlds_section(evidence),
        voxels_section(evidence),
        network_section(evidence),
    ]
