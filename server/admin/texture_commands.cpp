#include "server/admin/texture_commands.hpp"

#include <array>
#include <string>

#include "server/admin/command_call.hpp"
#include "server/textures/stored_textures.hpp"
#include "server/textures/texture_import.hpp"

namespace runstone {
namespace {

Result<std::string, std::string> parse_picture_folder(WordReader& reader) {
  return reader.result(
      reader.take_only("one folder of pictures comes after it, in quotes if it has blanks"));
}

enum class TexturesUse { given, shown };

void give_found_textures(const CommandCall& call, const TextureImport& found) {
  if (const auto why = call.world().cluster().textures_refusal())
    return call.refuse("materials textures: " + *why);
  const auto given = call.world().changes().give_textures(found.textures, call.now);
  if (!given) return call.refuse("materials textures: " + given.error());
  call.answer_when_durable(
      *given, textures_text(found) + "\ngiven, for ever (record " + std::to_string(*given) + ")");
}

void use_textures_of(const CommandCall& call, const std::string& place, TexturesUse use) {
  call.on_worker(
      "materials textures: ",
      [place, should_continue = call.services.rollback.should_continue()](
          WorldReader& reader) -> Result<TextureImport, std::string> {
        const auto materials = reader.materials();
        if (!materials) return failure(materials.error().message());
        const auto present = read_stored_textures(reader);
        if (!present) return failure(present.error());
        return import_textures(place, *materials, present->table, should_continue);
      },
      [call, use](const TextureImport& found) {
        if (found.textures.empty())
          return call.answer(textures_text(found) + "\nnothing is changed");
        if (use == TexturesUse::given) return give_found_textures(call, found);
        call.answer(textures_text(found) + "\nnothing is changed by a preview");
      });
}

void give_textures_of(const CommandCall& call, const std::string& place) {
  use_textures_of(call, place, TexturesUse::given);
}

void preview_textures_of(const CommandCall& call, const std::string& place) {
  use_textures_of(call, place, TexturesUse::shown);
}

constexpr std::array<CommandRow, 4> kTextureRows = {{
    // The first two rows refuse a line without a folder. Without them "textures" would be a part of
    // the name of a material, and "preview" a folder.
    {"materials textures", kLocal, "", parsed_by<parse_picture_folder, give_textures_of>()},
    {"materials textures preview", kLocal, "",
     parsed_by<parse_picture_folder, preview_textures_of>()},
    // The word FILE makes the control program send a whole path, also of a folder.
    {"materials textures FILE", kLocal,
     "materials textures FOLDER give materials the pictures of a folder: of PNGs that are named\n"
     "                          for them, of a game of Luanti, or of a resource pack of Minecraft\n"
     "materials textures preview FOLDER\n"
     "                          say what that would give",
     parsed_by<parse_picture_folder, give_textures_of>()},
    {"materials textures preview FILE", kLocal, "",
     parsed_by<parse_picture_folder, preview_textures_of>()},
}};

}  // namespace

std::span<const CommandRow> texture_commands() { return kTextureRows; }

}  // namespace runstone
