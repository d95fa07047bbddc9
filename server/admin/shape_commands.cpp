#include "server/admin/shape_commands.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "common/edits/descriptor/given_shapes.hpp"
#include "common/formats/shape_names.hpp"
#include "server/admin/command_call.hpp"
#include "server/admin/material_file.hpp"
#include "server/rollback/count_text.hpp"

namespace runstone {
namespace {

/// Returns a shape for each material of the table that is a cube, that is not empty, and whose name
/// says a shape. Thread: any. Cost: that of shape_of_material_name() for each material.
std::vector<GivenShape> shapes_of_names(const MaterialTable& table) {
  std::vector<GivenShape> rows;
  for (std::size_t id = 1; id < table.size(); ++id) {
    const MaterialInfo& info = table[static_cast<Material>(id)];
    if (!info.shape.is_cube() || info.visibility == Visibility::empty) continue;
    if (auto shape = shape_of_material_name(info.name))
      rows.push_back({static_cast<Material>(id), *std::move(shape)});
  }
  return rows;
}

Result<bool, std::string> parse_shapes_preview(WordReader& reader) {
  const bool is_preview = reader.take_word("preview");
  if (!reader.at_end())
    reader.wrong("materials shapes \"" + reader.peek() + "\": preview comes after it, or nothing");
  return reader.result(is_preview);
}

void give_shapes_of_names(const CommandCall& call, bool is_preview) {
  call.on_worker(
      "materials shapes: ",
      [](WorldReader& reader) -> StoreResult<std::vector<GivenShape>> {
        const auto table = reader.materials();
        if (!table) return failure(table.error());
        return shapes_of_names(*table);
      },
      [call, is_preview](const std::vector<GivenShape>& found) {
        const MaterialTable& table = call.world().order().materials();
        std::vector<GivenShape> rows;
        // A record may have given a shape since the reader read the table.
        std::copy_if(found.begin(), found.end(), std::back_inserter(rows),
                     [&](const GivenShape& row) { return table[row.material].shape.is_cube(); });
        if (rows.empty())
          return call.answer("every material has the shape that its name says: nothing is changed");
        const std::string count = counted(rows.size(), "material");
        if (is_preview)
          return call.answer(count +
                             " would get a shape, for ever: " + given_names_text(rows, table));
        if (const auto why = call.world().cluster().shapes_refusal())
          return call.refuse("materials shapes: " + *why);
        const auto given = call.world().changes().give_shapes(rows, call.now);
        if (!given) return call.refuse("materials shapes: " + given.error());
        call.answer_when_durable(*given, count + " got a shape (record " + std::to_string(*given) +
                                             "): " + given_names_text(rows, table));
      });
}

constexpr std::array<CommandRow, 1> kShapeRows = {{
    {"materials shapes", kLocal,
     "materials shapes [preview]  give materials the shapes that their names say",
     parsed_by<parse_shapes_preview, give_shapes_of_names>()},
}};

}  // namespace

std::span<const CommandRow> shape_commands() { return kShapeRows; }

}  // namespace runstone
