#include "server/world/order/world_chunks.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "common/core/assert.hpp"
#include "common/core/key_text.hpp"

namespace runstone {
namespace {

constexpr std::size_t kStackOverheadBytes = 256;  // an estimate
// Edits whose room the empty stack of a resident chunk keeps for the next ones.
constexpr std::size_t kStackKeptMax = 16;

// Returns the memory that an allocation takes: glibc adds a word, rounds up to 16 bytes and gives
// no less than 32.
constexpr std::size_t allocated(std::size_t bytes) {
  return bytes == 0 ? 0 : std::max<std::size_t>(32, (bytes + sizeof(void*) + 15) / 16 * 16);
}

}  // namespace

WorldChunks::Entry* WorldChunks::entry(const ChunkKey& key) { return entries_.find(key); }
const WorldChunks::Entry* WorldChunks::entry(const ChunkKey& key) const {
  return entries_.find(key);
}

void WorldChunks::set_saved(const ChunkKey& key, Version version) {
  Entry& e = entries_[key];
  RUNSTONE_ASSERT(e.stack.empty());
  e.version = e.saved = version;
}

void WorldChunks::replay_onto_stack(const ChunkKey& key, Version version,
                                    const EditDescriptor& edit, std::size_t bytes) {
  if (version <= entries_[key].saved) return;
  push(key, version, edit, bytes);
}

Sequence WorldChunks::push(const ChunkKey& key, Version version, const EditDescriptor& edit,
                           std::size_t bytes) {
  Entry& e = entries_[key];
  RUNSTONE_ASSERT(e.version < version);
  const Sequence previous = e.version.seq;
  e.version = version;
  if (e.residency == Residency::quarantined) {
    auto& first = quarantined_[key];
    if (!first) first = version.seq;
    return previous;
  }
  if (e.stack.empty()) bytes += kStackOverheadBytes;
  e.stack.push_back(edit);
  e.stack_seqs.push_back(version.seq);
  e.stack_bytes += bytes;
  stack_bytes_ += bytes;
  dirty_.insert(key);
  return previous;
}

void WorldChunks::apply_and_publish(const ChunkKey& key, Entry& e, Chunk chunk) {
  // Edits that the loaded chunk already contains are at the bottom of the stack.
  const auto first_new =
      std::upper_bound(e.stack_seqs.begin(), e.stack_seqs.end(), chunk.version.seq);
  const auto skip = static_cast<std::size_t>(first_new - e.stack_seqs.begin());
  const std::span<const EditDescriptor> edits = std::span(e.stack).subspan(skip);
  if (!edits.empty()) {
    apply_stack(chunk.voxels, chunk.digest, origin_of(key.at, edge_), edits, scratch_);
    stack_depths_.add(edits.size());
    chunk.version = e.version;
  }
  clear_stack(e);
  e.published = std::make_shared<const Chunk>(std::move(chunk));
  e.residency = Residency::resident;
  ++resident_count_;
  e.resident_bytes = bytes_of(e);
  resident_bytes_ += e.resident_bytes;
}

std::size_t WorldChunks::bytes_of(const Entry& e) {
  // A node of the hash table and its bucket, the key in idle_, and a shared pointer's two counters.
  constexpr std::size_t kNodeBytes =
      allocated(sizeof(std::pair<const ChunkKey, Entry>) + 2 * sizeof(void*)) + sizeof(void*);
  constexpr std::size_t kSharedBytes = allocated(sizeof(Chunk) + 2 * sizeof(void*));
  return kNodeBytes + sizeof(ChunkKey) + kSharedBytes +
         allocated(e.published->voxels.runs.byte_capacity()) +
         allocated(e.stack.capacity() * sizeof(EditDescriptor)) +
         allocated(e.stack_seqs.capacity() * sizeof(Sequence));
}

void WorldChunks::unpublish(Entry& e) {
  --resident_count_;
  resident_bytes_ -= std::exchange(e.resident_bytes, 0);
  e.published = nullptr;
}

void WorldChunks::clear_stack(Entry& e) {
  e.stack.clear();
  e.stack_seqs.clear();
  if (e.stack.capacity() > kStackKeptMax) {
    e.stack.shrink_to_fit();
    e.stack_seqs.shrink_to_fit();
  }
  stack_bytes_ -= std::exchange(e.stack_bytes, 0);
}

void WorldChunks::publish(const ChunkKey& key) {
  Entry* e = entry(key);
  if (e == nullptr || e->residency != Residency::resident || e->stack.empty()) return;
  Chunk copy = *e->published;
  unpublish(*e);
  apply_and_publish(key, *e, std::move(copy));
}

Residency WorldChunks::residency(const ChunkKey& key) const {
  const Entry* e = entry(key);
  return e == nullptr ? Residency::absent : e->residency;
}

ChunkPtr WorldChunks::find(const ChunkKey& key) const {
  const Entry* e = entry(key);
  return e == nullptr ? nullptr : e->published;
}

Version WorldChunks::version(const ChunkKey& key) const {
  const Entry* e = entry(key);
  return e == nullptr ? Version{} : e->version;
}

std::vector<std::pair<ChunkKey, ChunkPtr>> WorldChunks::edited() const {
  std::vector<std::pair<ChunkKey, ChunkPtr>> chunks;
  entries_.for_each([&](const ChunkKey& key, const Entry& e) {
    if (e.published != nullptr && e.version != Version{}) chunks.emplace_back(key, e.published);
  });
  std::sort(chunks.begin(), chunks.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  return chunks;
}

std::size_t WorldChunks::stack_size(const ChunkKey& key) const {
  const Entry* e = entry(key);
  return e == nullptr ? 0 : e->stack.size();
}

bool WorldChunks::begin_load(const ChunkKey& key) {
  Entry& e = entries_[key];
  if (e.residency != Residency::absent) return false;
  e.residency = Residency::loading;
  return true;
}

Result<void, std::string> WorldChunks::loaded(const ChunkKey& key, Chunk chunk) {
  Entry* e = entry(key);
  if (e == nullptr || e->residency != Residency::loading) return {};
  std::string wrong;
  if (chunk.voxels.extent != Extent::cube(static_cast<unsigned>(edge_))) {
    wrong = "its size differs from the world's chunk edge";
  } else if (chunk.version < e->saved || e->version < chunk.version) {
    wrong = "its version is " + text_of(chunk.version) + ", the world's is " + text_of(e->version) +
            " with a snapshot at " + text_of(e->saved);
  }
  if (!wrong.empty()) {
    quarantine(key);
    return failure(std::move(wrong));
  }
  apply_and_publish(key, *e, std::move(chunk));
  return {};
}

void WorldChunks::quarantine(const ChunkKey& key) {
  Entry* e = entry(key);
  if (e == nullptr || e->residency != Residency::loading) return;
  e->residency = Residency::quarantined;
  quarantined_[key] = e->stack_seqs.empty() ? std::nullopt : std::optional(e->stack_seqs.front());
  clear_stack(*e);
  dirty_.erase(key);
}

void WorldChunks::released(const ChunkKey& key) {
  Entry* e = entry(key);
  if (e == nullptr || e->residency != Residency::resident || e->is_candidate) return;
  e->is_candidate = true;
  idle_.push_back(key);
}

void WorldChunks::evict(std::size_t bytes_max, std::size_t steps_max,
                        const std::function<bool(const ChunkKey&)>& is_used) {
  for (std::size_t step = 0; step < steps_max && resident_bytes_ > bytes_max && !idle_.empty();
       ++step) {
    const ChunkKey key = idle_.front();
    idle_.pop_front();
    Entry& e = *entry(key);
    e.is_candidate = false;
    // A used chunk becomes a candidate again when its last user leaves. A chunk that is not in a
    // snapshot becomes one at once.
    if (is_used(key)) continue;
    if (e.version != e.saved) {
      released(key);
      continue;
    }
    unpublish(e);
    e.residency = Residency::absent;
    e.stack.shrink_to_fit();
    e.stack_seqs.shrink_to_fit();
    if (e.version == Version{}) entries_.erase(key);
  }
}

void WorldChunks::mark_saved(const ChunkKey& key, Version version) {
  Entry* e = entry(key);
  RUNSTONE_ASSERT(e != nullptr && version <= e->version);
  e->saved = std::max(e->saved, version);
  if (e->saved == e->version) dirty_.erase(key);
}

void WorldChunks::saved_up_to(Sequence seq) {
  for (auto at = dirty_.begin(); at != dirty_.end();) {
    Entry& e = *entry(*at);
    // A load that is under way may bring an older snapshot.
    if (e.version.seq > seq || e.residency == Residency::loading) {
      ++at;
      continue;
    }
    e.saved = e.version;
    if (e.residency == Residency::absent) clear_stack(e);
    at = dirty_.erase(at);
  }
}

std::optional<Sequence> WorldChunks::first_quarantined_edit() const {
  std::optional<Sequence> first;
  for (const auto& [key, seq] : quarantined_) {
    if (seq && (!first || *seq < *first)) first = seq;
  }
  return first;
}

}  // namespace runstone
