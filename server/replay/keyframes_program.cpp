#include "server/replay/keyframes_program.hpp"

#include <nlohmann/json.hpp>
#include <ostream>

#include "common/os/progress_line.hpp"
#include "server/history/keyframe_maker.hpp"
#include "server/replay/digest_list.hpp"
#include "server/store/world_folder.hpp"

namespace runstone {

Result<void, std::string> make_keyframes(const ReplayOptions& options, std::ostream& out) {
  const auto failure = [](const StoreError& error) {
    return Unexpected<std::string>{error.message()};
  };
  auto store = open_world(options.world, StoreAccess::read_write);
  if (!store) return failure(store.error());
  const auto generator = generator_of(**store);
  if (!generator) return Unexpected<std::string>{generator.error()};
  const auto before = (*store)->keyframes();
  if (!before) return failure(before.error());
  KeyframeMaker maker(**store, **generator, KeyframePolicy{options.keyframe_edits});
  std::uint64_t chunks_written = 0;
  {
    ProgressLine line("keyframes, edits", options.progress);
    const auto made = maker.make_due(
        [&](const KeyframeMaker::Chunks& chunks, const std::optional<Keyframe>& keyframe) {
          chunks_written += chunks.size();
          return (*store)->save_keyframe(chunks, keyframe);
        },
        [&](Sequence done, Sequence last) {
          line.show(done, last);
          return true;
        });
    if (!made) return failure(made.error());
  }
  out << "keyframes   " << maker.made() << " made of " << chunks_written << " chunks, "
      << before->size() << " there before\n";
  if (options.json.empty()) return {};
  const nlohmann::ordered_json json = {{"made", maker.made()},
                                       {"chunks", chunks_written},
                                       {"keyframes", before->size() + maker.made()}};
  const auto written = write_text_file(options.json, json.dump(1) + "\n");
  if (!written) return Unexpected<std::string>{written.error().message()};
  return {};
}

}  // namespace runstone
