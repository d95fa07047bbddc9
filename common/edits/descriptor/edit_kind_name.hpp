// The name of a kind of edits, for people: in lines of the log, on the map, in the client.
#pragma once
#include "common/edits/descriptor/edit_descriptor.hpp"

namespace runstone {

/// Returns one word in lower case, such as "box". A kind that this program does not know is an
/// "edit".
constexpr const char* name_of(EditKind kind) {
  switch (kind) {
    case EditKind::set_voxel:
      return "voxel";
    case EditKind::fill_box:
      return "box";
    case EditKind::fill_sphere:
      return "sphere";
    case EditKind::fill_stroke:
      return "stroke";
    case EditKind::paste:
      return "paste";
    case EditKind::rights:
      return "rights";
    case EditKind::materials:
    case EditKind::materials_with_looks:
      return "materials";
    case EditKind::library:
      return "library";
    case EditKind::shapes:
      return "shapes";
    case EditKind::texture:
      return "texture";
    case EditKind::clock:
      return "clock";
    case EditKind::gap:
      return "gap";
  }
  return "edit";
}

}  // namespace runstone
