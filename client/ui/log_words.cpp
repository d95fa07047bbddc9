#include "client/ui/log_words.hpp"

#include <imgui.h>

#include "client/render/author_rgb.hpp"
#include "common/edits/descriptor/edit_kind_name.hpp"

namespace runstone {
namespace {

std::string kind_words(EditKind kind) {
  switch (kind) {
    case EditKind::rights:
      return "change of rights";
    case EditKind::materials:
    case EditKind::materials_with_looks:
      return "new materials";
    case EditKind::library:
      return "change of the library";
    case EditKind::shapes:
      return "shapes of materials";
    case EditKind::texture:
      return "texture of materials";
    case EditKind::clock:
      return "time of the world";
    case EditKind::gap:
      return "lost record";
    default:
      return name_of(kind);
  }
}

}  // namespace

std::string record_words(EditKind kind, Cause cause) {
  switch (cause) {
    case Cause::undo:
      return "undo";
    case Cause::redo:
      return "redo";
    case Cause::rollback:
      return "rollback";
    case Cause::import:
      return "import (" + kind_words(kind) + ")";
    case Cause::player:
    case Cause::console:
    case Cause::rights:
    case Cause::materials:
    case Cause::library:
    case Cause::textures:
    case Cause::clock:
    case Cause::gap:
      return kind_words(kind);
  }
  return kind_words(kind);
}

std::uint32_t author_colour(AuthorId author) {
  const auto [r, g, b] = author_rgb(author);
  return IM_COL32(r, g, b, 255);
}

}  // namespace runstone
