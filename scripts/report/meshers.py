"""Names and colours of the meshers. A mesher has one colour in all figures."""
from dataclasses import dataclass


@dataclass(frozen=True)
class Mesher:
    key: str  # name in runstone-bench
    name: str
    short: str
    light: str  # colour on white
    dark: str  # colour on black
    start: str = "grid"  # what it starts from: runs, grid or mask
    merges: bool = True  # joins faces to larger polygons
    is_variant: bool = False  # has the same mesh as another one


MESHERS = {
    m.key: m
    for m in (
        Mesher("rdm", "ours: RDM from runs", "RDM (ours)", "#0b62a8", "#5aa9f0", "runs"),
        Mesher("rdm_kept", "ours, borders kept", "RDM, kept", "#3f88c0", "#8cc4f2", "runs", True, True),
        Mesher("rdm_plain", "ours, no vectors", "RDM, plain", "#6a9cc0", "#a9cbe6", "runs", True, True),
        Mesher("decode_binary", "decode + binary greedy", "decode+binary", "#c2410c", "#fb8b4b", "runs"),
        Mesher(
            "padded_binary", "padded runs + binary greedy", "padded+binary", "#d2691e", "#f7a76c", "runs", True, True
        ),
        Mesher("grid_binary", "binary greedy (grid ready)", "binary, grid", "#a8690f", "#e3a84a", "grid", True, True),
        Mesher(
            "mask_binary",
            "binary greedy (grid and mask ready)",
            "binary, mask",
            "#857006",
            "#d8bf3d",
            "mask",
            True,
            True,
        ),
        Mesher("culled", "culled faces over an octree", "culled", "#1b7f4e", "#55c48b", "octree", False),
        Mesher("simple", "simple (grid ready)", "simple", "#5a8f2a", "#9cc96b", "grid", False),
        Mesher("grid_rdm", "thesis' Grid RDM (grid ready)", "Grid RDM", "#5b3fa9", "#a996f1", "grid"),
        Mesher("rle_rdm", "thesis' RLE RDM", "RLE RDM", "#92308c", "#dc8cd7", "runs"),
        Mesher("greedy", "greedy (grid ready)", "greedy", "#6b6b6c", "#b0b0b1"),
        Mesher("naive_greedy", "naive greedy (grid ready)", "naive greedy", "#7d6f63", "#bfb1a5"),
        Mesher("run_strips", "run strips (grid ready)", "run strips", "#3f7a80", "#84c0c6"),
        Mesher("run_strips_hidden", "run strips over hidden faces", "strips, hidden", "#6f969b", "#a9d0d5"),
        Mesher("optimal_greedy", "optimal greedy (grid ready)", "optimal", "#a33b5b", "#ec8aa8"),
        Mesher("monotone", "monotone (grid ready)", "monotone", "#8c5a3d", "#d3a384"),
        Mesher("poly2tri", "Poly2Tri (grid ready)", "Poly2Tri", "#a1703f", "#e0bb92"),
    )
}

# The meshers of the thesis: name in its results, mesher that was rebuilt from its description.
THESIS_MESHERS = (
    ("Grid", "grid_rdm", "Grid RDM"),
    ("RLE", "rle_rdm", "RLE RDM"),
    ("VoxelPlugin", "culled", "Voxel Plugin"),
)


def mesher(key):
    """Returns a mesher. One that this table does not know is grey."""
    plain = str(key).replace("_", " ")
    return MESHERS.get(key) or Mesher(str(key), plain, plain, "#707071", "#a6a6a7")
