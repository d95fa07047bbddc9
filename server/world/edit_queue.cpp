#include "server/world/edit_queue.hpp"

#include <algorithm>
#include <optional>
#include <variant>

#include "common/edits/descriptor/edit_geometry.hpp"
#include "common/edits/descriptor/edit_memory.hpp"
#include "protocol/limits.hpp"

namespace runstone {
namespace {

// The work of an edit: an upper bound of its bytes in a commit message, in which its chunks weigh
// more because each of them is swept. A commit that holds a single edit may have more than
// kWorkMax. With kWorkMax, the slowest commit takes a few milliseconds.
constexpr std::size_t kWorkMax = 128 * 1024;
constexpr std::size_t kEditWork = 128;     // the fields of OrderedEdit without the descriptor
constexpr std::size_t kChunkWork = 64;     // at least 10, a varint of OrderedEdit::previous
constexpr std::size_t kClipboardWork = 2;  // for a byte, at least 1
static_assert(kWorkMax < kServerEditBytesMax / 2 && kEditWork +
                                                            kClipboardWork * kDescriptorBytesMax +
                                                            kChunkWork * kTouchedChunksMax <
                                                        kServerEditBytesMax / 2,
              "every commit fits its message");

std::size_t work_of(const EditDescriptor& edit, std::int32_t chunk_edge) {
  const auto* paste = std::get_if<Paste>(&edit.shape);
  const std::size_t descriptor = paste == nullptr
                                     ? descriptor_bytes_max(kind_of(edit))
                                     : 64 + kClipboardWork * paste->clipboard->byte_size();
  const std::size_t chunks =
      std::min<std::size_t>(touched_chunks_bound(edit, chunk_edge), kTouchedChunksMax);
  return kEditWork + descriptor + kChunkWork * chunks;
}

std::size_t memory_of(const EditOffer& offer) {
  return sizeof(EditOffer) + memory_bytes(offer.edit);
}

}  // namespace

void EditQueue::push(const EditOffer& offer) {
  lanes_[{offer.op.author, offer.op.instance}].push_back({offer, work_of(offer.edit, chunk_edge_)});
  bytes_ += memory_of(offer);
  ++size_;
}

std::vector<EditOffer> EditQueue::take() {
  std::vector<EditOffer> out;
  std::size_t work = 0;
  std::optional<Client> skipped;
  auto lane = lanes_.lower_bound(turn_);
  for (bool has_taken = true; has_taken;) {
    has_taken = false;
    for (std::size_t left = lanes_.size(); left > 0 && out.size() < kCommitEditsMax; --left) {
      if (lane == lanes_.end()) lane = lanes_.begin();
      Waiting& next = lane->second.front();
      if (!out.empty() && work + next.work > kWorkMax) {
        if (!skipped) skipped = lane->first;
        ++lane;
        continue;
      }
      has_taken = true;
      work += next.work;
      bytes_ -= memory_of(next.offer);
      --size_;
      out.push_back(std::move(next.offer));
      lane->second.pop_front();
      lane = lane->second.empty() ? lanes_.erase(lane) : std::next(lane);
    }
  }
  turn_ = skipped ? *skipped : lane == lanes_.end() ? Client{} : lane->first;
  return out;
}

}  // namespace runstone
