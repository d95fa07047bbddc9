#include "server/repair/repair_report.hpp"

#include <algorithm>
#include <ostream>

#include "common/core/key_text.hpp"
#include "common/core/utc_text.hpp"

namespace runstone {
namespace {

/// The greatest number of lines of one list. The rows behind them are counted.
constexpr std::size_t kLinesMax = 1'000;
constexpr std::size_t kChunksNamedMax = 8;

template <class Row, class Text>
void print_list(const std::vector<Row>& rows, std::ostream& out, const char* name, Text text) {
  for (std::size_t i = 0; i < rows.size() && i < kLinesMax; ++i)
    out << name << text(rows[i]) << '\n';
  if (rows.size() > kLinesMax) out << name << "and " << rows.size() - kLinesMax << " more\n";
}

/// Returns the coordinates of the first kChunksNamedMax chunks that a box meets.
std::string chunks_text(const VoxelBox& box, std::int32_t edge) {
  if (box.empty()) return "";
  const ChunkCoord first = chunk_of(box.min, edge);
  const ChunkCoord last = chunk_of({box.max.x - 1, box.max.y - 1, box.max.z - 1}, edge);
  std::string text;
  std::size_t named = 0;
  for (std::int64_t y = first.y; y <= last.y; ++y) {
    for (std::int64_t z = first.z; z <= last.z; ++z) {
      for (std::int64_t x = first.x; x <= last.x; ++x) {
        if (++named > kChunksNamedMax) return " chunks" + text + " and more";
        text += " " + std::to_string(x) + "," + std::to_string(y) + "," + std::to_string(z);
      }
    }
  }
  return " chunks" + text;
}

std::string lost_text(const GoneEdit& edit, std::int32_t edge) {
  std::string text = "seq=" + std::to_string(edit.seq);
  if (edit.author != 0) text += " author=#" + std::to_string(edit.author);
  if (edit.cause == Cause::rights) text += " a change of rights";
  if (edit.from_us != 0)
    text += " between " + utc_text(edit.from_us) + " and " + utc_text(edit.until_us);
  if (edit.box) text += chunks_text(*edit.box, edge);
  return text;
}

}  // namespace

void print(const RepairReport& report, std::int32_t edge, std::ostream& out) {
  const auto line = [](const std::string& text) { return text; };
  print_list(report.damage, out, "damage      ", line);
  out << "kept        " << report.records << " records of the log\n";
  if (report.records_from_backup != 0)
    out << "taken       " << report.records_from_backup << " records of the log from the backup\n";
  print_list(report.taken, out, "taken       ", line);
  print_list(report.lost, out, "lost        ",
             [&](const GoneEdit& edit) { return lost_text(edit, edge); });
  print_list(report.losses, out, "lost        ", line);
  if (report.materials_made != 0) {
    out << "materials   " << report.materials_made
        << " rows named lost_ID stand for materials that are lost\n";
  }
  const bool has_lost_rights = std::ranges::any_of(
      report.lost, [](const GoneEdit& edit) { return !edit.cause || edit.cause == Cause::rights; });
  if (has_lost_rights) {
    out << "rights      changes of rights may be lost: look at roles, bans and protected boxes\n";
  }
  print_list(report.ground, out, "ground      ", [](const KeptGround& ground) {
    return "chunk=" + text_of(ground.key) + " " + std::to_string(ground.voxels) +
           " voxels from its snapshot, which shows lost edits";
  });
  out << "epoch       " << report.epoch << ", of a new branch: clients load every chunk again\n";
}

}  // namespace runstone
