#include "server/replay/replay_commands.hpp"

#include <nlohmann/json.hpp>
#include <ostream>
#include <utility>

#include "common/os/progress_line.hpp"
#include "server/history/keyframe_maker.hpp"
#include "server/replay/command_world.hpp"
#include "server/replay/subcommand.hpp"
#include "server/store/world_folder.hpp"

namespace runstone {

void declare_keyframes(SubcommandOptions& command_line, KeyframesOptions& options) {
  command_line.common(options.common, "folder of the world; no server may be running it");
  command_line.number("--keyframe-edits", options.keyframe_edits, 1, 1'000'000'000,
                      "least number of edits between two keyframes; default 32768");
}

Result<int, std::string> run_keyframes(const KeyframesOptions& options, std::ostream& out) {
  auto store = open_world(options.common.world, StoreAccess::read_write);
  if (!store) return failure(store.error().message());
  const auto generator = generator_of(**store);
  if (!generator) return failure(generator.error());
  const auto before = (*store)->keyframes();
  if (!before) return failure(before.error().message());
  KeyframeMaker maker(**store, **generator, KeyframePolicy{options.keyframe_edits});
  std::uint64_t chunks_written = 0;
  {
    ProgressLine line("keyframes, edits", options.common.progress);
    const auto made = maker.make_due(
        [&](const KeyframeMaker::Chunks& chunks, const std::optional<Keyframe>& keyframe) {
          chunks_written += chunks.size();
          return (*store)->save_keyframe(chunks, keyframe);
        },
        [&](Sequence done, Sequence last) {
          line.show(done, last);
          return true;
        });
    if (!made) return failure(made.error().message());
  }
  row(out, "keyframes") << maker.made() << " made of " << chunks_written << " chunks, "
                        << before->size() << " there before\n";
  const nlohmann::ordered_json json = {{"made", maker.made()},
                                       {"chunks", chunks_written},
                                       {"keyframes", before->size() + maker.made()}};
  const auto written = write_report(options.common.json, json.dump(1));
  if (!written) return failure(written.error());
  return kReplayEqual;
}

}  // namespace runstone
