#include "client/build/action_progress.hpp"

#include <algorithm>

namespace runstone {
namespace {

/// Returns a number with a comma between thousands.
std::string grouped(std::uint64_t number) {
  std::string text = std::to_string(number);
  for (std::size_t i = text.size(); i > 3; i -= 3) text.insert(i - 3, ",");
  return text;
}

std::string refused_text(const ActionProgress& progress) {
  if (progress.edits_refused == 0) return {};
  return "; left out " + grouped(progress.voxels_refused) + " voxels in " +
         grouped(progress.edits_refused) + (progress.edits_refused == 1 ? " part: " : " parts: ") +
         progress.refusal;
}

}  // namespace

std::optional<unsigned> ActionProgress::percent() const {
  if (voxels == 0) return std::nullopt;
  const std::uint64_t answered = std::min(voxels, voxels_done + voxels_refused);
  return static_cast<unsigned>(static_cast<double>(answered) * 100 / static_cast<double>(voxels));
}

std::uint64_t ActionProgress::voxels_per_second() const {
  if (!began_us || now_us <= *began_us) return 0;
  return static_cast<std::uint64_t>(static_cast<double>(voxels_done) * 1e6 /
                                    static_cast<double>(now_us - *began_us));
}

std::optional<TimeUs> ActionProgress::left_us() const {
  const std::uint64_t rate = voxels_per_second();
  const std::uint64_t answered = voxels_done + voxels_refused;
  if (rate == 0 || voxels == 0 || answered > voxels) return std::nullopt;
  return static_cast<TimeUs>(static_cast<double>(voxels - answered) * 1e6 /
                             static_cast<double>(rate));
}

std::string text_of(const std::string& name, const ActionProgress& progress) {
  std::string text = name + ": ";
  const auto percent = progress.percent();
  text +=
      percent ? std::to_string(*percent) + " percent" : grouped(progress.voxels_done) + " voxels";
  text += ", " + grouped(progress.voxels_per_second()) + " voxels a second";
  if (const auto left = progress.left_us())
    text += ", " + grouped(static_cast<std::uint64_t>(*left / 1'000'000) + 1) + " s left";
  text += refused_text(progress);
  if (!progress.waits_for.empty()) text += "; waits for: " + progress.waits_for;
  return text;
}

std::string end_text_of(const std::string& name, const ActionProgress& progress) {
  std::string text = name + ": " + grouped(progress.voxels_done) + " voxels";
  text += refused_text(progress);
  if (!progress.stop_reason.empty()) {
    text += "; it ended early: " + progress.stop_reason;
    if (progress.edits_done > 0) text += "; an undo takes back what was done";
  }
  return text;
}

}  // namespace runstone
