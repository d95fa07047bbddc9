#include "client/bots/recorded_log.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "common/core/text.hpp"
#include "protocol/limits.hpp"

namespace runstone {
namespace {

/// Returns how much later the second of two times of a file is, in microseconds, at most the largest
/// TimeUs. Returns 0 if it is earlier: there the log corrects its time.
TimeUs between(TimeUs first, TimeUs later) {
  if (later < first) return 0;
  const std::uint64_t apart = static_cast<std::uint64_t>(later) - static_cast<std::uint64_t>(first);
  return static_cast<TimeUs>(std::min<std::uint64_t>(
      apart, static_cast<std::uint64_t>(std::numeric_limits<TimeUs>::max())));
}

void note_materials(const EditDescriptor& edit, std::vector<bool>& used) {
  if (const auto* paste = std::get_if<Paste>(&edit.shape)) {
    for (const Material material : paste->clipboard->palette()) used[material] = true;
  }
  used[edit.material] = true;
  used[edit.mask.material] = true;
}

}  // namespace

std::string session_name(const std::string& recorded, AuthorId author) {
  if (author == 0) return "recorded world";
  const std::string_view name = cut_utf8(recorded, kPlayerNameBytesMax);
  return is_plain_name(name) ? std::string(name) : "author " + std::to_string(author);
}

Result<RecordedLog, std::string> read_recorded_log(RlogSource source) {
  auto reader = RlogReader::open(std::move(source));
  if (!reader) return failure(reader.error().message());
  auto materials = parse_material_table(reader->world().materials, "materials");
  if (!materials) return failure(materials.error().message());
  RecordedLog log;
  log.materials = *std::move(materials);
  std::map<AuthorId, RecordedAuthor> authors;
  std::vector<bool> used(kMaterialCountMax, false);
  TimeUs last_us = 0, passed_us = 0;
  std::string wrong;
  const auto read = reader->read(1, [&](const EditRecord& record) {
    if (const AddedMaterials* added = added_materials_of(record.edit)) {
      const auto appended = log.materials.append(added->first, added->rows);
      if (!appended)
        wrong = "edit " + std::to_string(record.version.seq) + ": " + appended.error().what;
      return appended.has_value();
    }
    if (const GivenShapes* given = given_shapes_of(record.edit)) {
      const auto shaped = log.materials.give_shapes(given->rows);
      if (!shaped)
        wrong = "edit " + std::to_string(record.version.seq) + ": " + shaped.error().what;
      return shaped.has_value();
    }
    if (!has_voxels(record.edit)) return true;  // the live world has rights of its own
    const TimeUs step_us = log.edits == 0 ? 0 : between(last_us, record.time_us);
    passed_us = step_us > std::numeric_limits<TimeUs>::max() - passed_us
                    ? std::numeric_limits<TimeUs>::max()
                    : passed_us + step_us;
    last_us = record.time_us;
    if (!log.materials.knows(material_max(record.edit))) {
      wrong = "edit " + std::to_string(record.version.seq) + " uses material " +
              std::to_string(material_max(record.edit)) +
              ", which the file's table of materials lacks";
      return false;
    }
    note_materials(record.edit, used);
    authors[record.op.author].edits.push_back({passed_us, record.edit});
    ++log.edits;
    return true;
  });
  if (!wrong.empty()) return failure(wrong);
  if (!read) return failure(read.error().message());
  for (const RlogPlayer& player : reader->players()) {
    if (const auto found = authors.find(player.author); found != authors.end()) {
      found->second.name = player.name;
    }
  }
  for (auto& [author, recorded] : authors) {
    recorded.author = author;
    recorded.name = session_name(recorded.name, author);
    log.authors.push_back(std::move(recorded));
  }
  for (std::size_t id = 0; id < used.size(); ++id) {
    if (used[id]) log.used.push_back(static_cast<Material>(id));
  }
  return log;
}

Result<void, std::string> check_materials(const RecordedLog& log, const MaterialTable& live) {
  for (const Material id : log.used) {
    const std::string& name = log.materials[id].name;
    if (!live.knows(id)) {
      return failure("material " + std::to_string(id) + " is \"" + name +
                     "\" in the file, and the world's table of materials ends before it");
    }
    if (live[id].name != name) {
      return failure("material " + std::to_string(id) + " is \"" + name + "\" in the file and \"" +
                     live[id].name + "\" in the world");
    }
  }
  return {};
}

}  // namespace runstone
