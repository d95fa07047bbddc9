#include "client/display/upload_tracker.hpp"

#include <algorithm>

namespace runstone {

void UploadTracker::queued(const ChunkKey& key, std::uint64_t number, Urgency urgency) {
  Waiting& waiting = waiting_[key];
  waiting.number = number;
  if (urgency == Urgency::terrain) return;
  if (waiting.edits.empty()) ++chunks_with_edits_;
  waiting.edits.push_back(number);
}

void UploadTracker::removed(const ChunkKey& key) {
  const auto found = waiting_.find(key);
  if (found == waiting_.end()) return;
  if (!found->second.edits.empty()) --chunks_with_edits_;
  waiting_.erase(found);
}

void UploadTracker::uploaded(const ChunkKey& key, std::uint64_t number) {
  has_uploaded_ = true;
  const auto found = waiting_.find(key);
  if (found == waiting_.end()) return;
  std::vector<std::uint64_t>& edits = found->second.edits;
  if (!edits.empty() && edits.front() <= number) {
    first_uploaded_edit_ = std::min(first_uploaded_edit_, edits.front());
    edits.erase(edits.begin(), std::upper_bound(edits.begin(), edits.end(), number));
    if (edits.empty()) --chunks_with_edits_;
  }
  if (found->second.number <= number) waiting_.erase(found);
}

void UploadTracker::presented() {
  has_uploaded_ = false;
  first_uploaded_edit_ = kNone;
}

bool UploadTracker::has_edits_up_to(std::uint64_t number) const {
  return first_uploaded_edit_ <= number ||
         std::any_of(waiting_.begin(), waiting_.end(), [number](const auto& entry) {
           const std::vector<std::uint64_t>& edits = entry.second.edits;
           return !edits.empty() && edits.front() <= number;
         });
}

}  // namespace runstone
