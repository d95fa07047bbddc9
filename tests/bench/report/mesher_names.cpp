#include "tests/bench/report/mesher_names.hpp"

#include <algorithm>
#include <array>

namespace runstone::bench {
namespace {

struct Name {
  std::string_view mesher, long_name, short_name;
  bool is_variant = false;
};
constexpr std::array kNames = {
    Name{"rdm", "ours: RDM from runs", "RDM (ours)"},
    Name{"rdm_kept", "ours, borders kept", "RDM, kept", true},
    Name{"rdm_plain", "ours, no vectors", "RDM, plain", true},
    Name{"decode_binary", "decode + binary greedy", "decode+binary"},
    Name{"padded_binary", "padded runs + binary greedy", "padded+binary", true},
    Name{"grid_binary", "binary greedy (grid ready)", "binary, grid", true},
    Name{"mask_binary", "binary greedy (mask ready)", "binary, mask", true},
    Name{"culled", "culled over an octree", "culled"},
    Name{"simple", "simple (grid ready)", "simple"},
    Name{"grid_rdm", "thesis' Grid RDM (grid ready)", "Grid RDM"},
    Name{"rle_rdm", "thesis' RLE RDM", "RLE RDM"},
    Name{"greedy", "greedy (grid ready)", "greedy"},
    Name{"naive_greedy", "naive greedy (grid ready)", "naive greedy"},
    Name{"run_strips", "run strips (grid ready)", "run strips"},
    Name{"run_strips_hidden", "run strips over hidden faces", "strips, hidden"},
    Name{"optimal_greedy", "optimal greedy (grid ready)", "optimal"},
    Name{"monotone", "monotone (grid ready)", "monotone"},
    Name{"poly2tri", "Poly2Tri (grid ready)", "Poly2Tri"},
};

const Name* find(std::string_view mesher) {
  const auto* const found = std::find_if(kNames.begin(), kNames.end(),
                                         [&](const Name& name) { return name.mesher == mesher; });
  return found == kNames.end() ? nullptr : found;
}

std::string plain(std::string_view mesher) {
  std::string out(mesher);
  std::replace(out.begin(), out.end(), '_', ' ');
  return out;
}

}  // namespace

std::string long_name_of(std::string_view mesher) {
  const Name* name = find(mesher);
  return name == nullptr ? plain(mesher) : std::string(name->long_name);
}

std::string short_name_of(std::string_view mesher) {
  const Name* name = find(mesher);
  return name == nullptr ? plain(mesher) : std::string(name->short_name);
}

chart::Role role_of(std::string_view mesher) {
  if (mesher.starts_with("rdm")) return chart::Role::ours;
  if (mesher.ends_with("_binary")) return chart::Role::baseline;
  return chart::Role::other;
}

bool is_variant(std::string_view mesher) {
  const Name* name = find(mesher);
  return name != nullptr && name->is_variant;
}

}  // namespace runstone::bench
