#include "client/replica/replica.hpp"

#include <algorithm>
#include <utility>

#include "client/replica/layer_diff.hpp"
#include "common/core/assert.hpp"
#include "common/edits/edit_geometry.hpp"

namespace runstone {
namespace {

/// The voxels of a chunk, kept alive by it.
ShownPtr voxels_of(const ChunkPtr& chunk) { return {chunk, &chunk->voxels}; }

}  // namespace

/// What all chunks of one ordered edit share.
struct Replica::EditInfo {
  OperationId op;
  Version version;
  EditDescriptor edit;
  TimeUs submitted_us = 0, ordered_us = 0;
  TimeUs received_us = 0, unpacked_us = 0;
};

// ---- opening, view
// ---------------------------------------------------------------------------------------------

std::vector<ClientSequence> Replica::open(const Opening& opening) {
  if (opening_ && opening_->chunk_edge != opening.chunk_edge) reset();
  // Of what the last server ordered, only what we heard to be durable survived its end for sure: by now the
  // log may have grown past that again, with other edits.
  const Sequence kept = std::min(durable_, opening.durable);
  opening_ = opening;
  durable_ = opening.durable;
  newest_ = opening.head;
  requests_.clear();
  current_count_ = 0;
  for (auto& [key, entry] : entries_) {
    entry.current = false;
    entry.inbox.clear();
    entry.latest = 0;
    entry.awaiting = false;
    if (!entry.confirmed) continue;
    const Version version = entry.confirmed->version;
    if (version.epoch < opening.epoch && version.seq > kept) {
      // The server that ordered this is gone and may not have kept it. What is on the screen stays until the
      // new snapshot.
      entry.confirmed = nullptr;
      --confirmed_count_;
      ++counters_.dropped_by_epoch;
    }
  }
  const auto offers = own_.resume(opening.decided);
  for (auto& [key, entry] : entries_) {
    for (Pending& pending : entry.pending) {
      const OwnEdit* own = own_.find(pending.seq);
      pending.until_snapshot = own == nullptr || own->decided;
      pending.decided_at = 0;
    }
  }
  for (const ClientSequence seq : offers) {
    const OwnEdit& own = *own_.find(seq);
    for (const ChunkKey& key : own.chunks) {
      const auto it = entries_.find(key);
      if (it == entries_.end()) continue;
      auto& pending = it->second.pending;
      const auto place = std::lower_bound(pending.begin(), pending.end(), seq,
                                          [](const Pending& p, ClientSequence s) { return p.seq < s; });
      if (place == pending.end() || place->seq != seq) pending.insert(place, {seq, own.edit, 0, false});
    }
    ++counters_.own_offered_again;
  }
  settle_own();
  return own_.unanswered();
}

void Replica::reset() {
  for (const auto& [key, entry] : entries_) {
    if (entry.shown) chunk_news(key).removed = true;
  }
  entries_.clear();
  confirmed_count_ = current_count_ = 0;
  own_.clear();
  requests_.clear();
  opening_.reset();
}

void Replica::set_view(const View& view) {
  view_ = view;
  for (auto it = entries_.begin(); it != entries_.end();) {
    if (view.contains(it->first.at)) {
      ++it;
      continue;
    }
    if (it->second.shown) {
      ChunkNews& news = chunk_news(it->first);
      news = {};
      news.key = it->first;
      news.removed = true;
    }
    if (it->second.confirmed) --confirmed_count_;
    if (it->second.current) --current_count_;
    it = entries_.erase(it);
  }
}

Replica::Entry& Replica::entry_for(const ChunkKey& key) {
  const auto [it, fresh] = entries_.try_emplace(key);
  if (fresh) {
    const VoxelBox box = box_of(key.at, opening_->chunk_edge);
    for (const auto& [seq, own] : own_.all()) {
      if (!own.decided && touches(own.edit, box)) it->second.pending.push_back({seq, own.edit, 0, false});
    }
  }
  return it->second;
}

// ---- own edits
// -------------------------------------------------------------------------------------------------

Result<ClientSequence> Replica::submit(const EditDescriptor& edit, TimeUs submitted_us, TimeUs now_us) {
  if (!opening_) return fail(ErrorCode::bad_value, "no world is open");
  if (const auto ok = validate(edit); !ok) return Unexpected<Error>{ok.error()};
  if (touched_chunks_bound(edit, opening_->chunk_edge) > kTouchedChunksMax) {
    return fail(ErrorCode::limit_exceeded, "edit touches too many chunks");
  }
  if (own_.full()) return fail(ErrorCode::limit_exceeded, "too many own edits wait for the server");

  OwnEdit own;
  own.edit = edit;
  own.submitted_us = submitted_us;
  for (const ChunkCoord at : touched_chunks(edit, opening_->chunk_edge)) own.chunks.push_back({0, at});
  const std::vector<ChunkKey> chunks = own.chunks;
  const ClientSequence seq = own_.add(std::move(own));
  ++counters_.own_submitted;

  auto news = std::make_unique<EditNews>();
  news->op = {opening_->author, opening_->instance, seq};
  news->own = true;
  news->predicted = true;
  news->received_us = news->unpacked_us = news->applied_us = now_us;
  for (const ChunkKey& key : chunks) {
    const auto it = entries_.find(key);
    if (it == entries_.end()) continue;
    Entry& entry = it->second;
    entry.pending.push_back({seq, edit, 0, false});
    if (!entry.shown) continue;
    // On top of the stack, so it goes onto what is shown already.
    auto next = std::make_shared<RunChunk>(*entry.shown);
    Digest unused;
    if (apply_stack(*next, unused, origin(key), {&edit, 1}, scratch_).changed) {
      show(key, entry, std::move(next), {news.get()});
    }
  }
  edit_news_.push_back(std::move(news));
  return seq;
}

void Replica::mark_sent(ClientSequence seq, TimeUs now_us) {
  if (OwnEdit* own = own_.find(seq)) own->sent_us = now_us;
}

bool Replica::is_own(const OperationId& op) const {
  return op.author == opening_->author && op.instance == opening_->instance;
}

ShownPtr Replica::predict(const ChunkKey& key, const Entry& entry) {
  if (entry.pending.empty()) return voxels_of(entry.confirmed);
  std::vector<EditDescriptor> stack;
  stack.reserve(entry.pending.size());
  for (const Pending& pending : entry.pending) stack.push_back(pending.edit);
  auto next = std::make_shared<RunChunk>(entry.confirmed->voxels);
  Digest unused;
  apply_stack(*next, unused, origin(key), stack, scratch_);
  return next;
}

// ---- messages
// --------------------------------------------------------------------------------------------------

void Replica::receive(ChunkSnapshot snapshot, const Arrival& arrival) {
  if (!opening_ || snapshot.key.lod != 0 || !view_ || !view_->contains(snapshot.key.at)) {
    ++counters_.snapshots_outside;
    return;
  }
  Entry& entry = entry_for(snapshot.key);
  if (!entry.current) ++current_count_;
  entry.current = true;
  if (entry.confirmed) {
    const Version held = entry.confirmed->version;
    const bool repairs = entry.awaiting && snapshot.chunk.version == held;
    if (snapshot.chunk.version <= held && !repairs) {
      if (snapshot.chunk.version < held) ++counters_.snapshots_stale;
      // Nothing new, but what was answered while we could not listen is in here, and so in what we hold.
      const auto settled = std::erase_if(entry.pending, [](const Pending& p) { return p.until_snapshot; });
      if (!entry.awaiting) {
        settle(snapshot.key, entry, true, arrival.now_us);
      } else if (settled != 0) {
        show(snapshot.key, entry, predict(snapshot.key, entry), {});
      }
      return;
    }
  } else {
    ++confirmed_count_;
  }
  ++counters_.snapshots_taken;
  const Sequence seq = snapshot.chunk.version.seq;
  newest_ = std::max(newest_, seq);
  entry.confirmed = std::make_shared<const Chunk>(std::move(snapshot.chunk));
  entry.awaiting = false;
  std::erase_if(entry.pending, [seq](const Pending& p) {
    return p.until_snapshot || (p.decided_at != 0 && p.decided_at <= seq);
  });
  settle(snapshot.key, entry, true, arrival.now_us);
}

Result<void> Replica::receive(const Commit& commit, const Arrival& arrival) {
  if (!opening_) return fail(ErrorCode::bad_value, "commit before ready");
  if (commit.epoch != opening_->epoch) return fail(ErrorCode::bad_value, "commit of another epoch");
  ++counters_.commits;
  std::map<ChunkKey, Entry*> touched_entries;
  for (std::size_t i = 0; i < commit.edits.size(); ++i) {
    const OrderedEdit& ordered = commit.edits[i];
    const Version version{commit.epoch, commit.first + i};
    const auto chunks = touched_chunks(ordered.edit, opening_->chunk_edge);
    if (chunks.size() != ordered.previous.size()) {
      return fail(ErrorCode::bad_value, "previous sequences do not fit the edit", i);
    }
    newest_ = std::max(newest_, version.seq);
    std::shared_ptr<const EditInfo> info;
    const auto shared_info = [&] {
      if (!info) {
        info = std::make_shared<const EditInfo>(EditInfo{ordered.op, version, ordered.edit,
                                                         ordered.submitted_us, ordered.ordered_us,
                                                         arrival.received_us, arrival.unpacked_us});
      }
      return info;
    };
    const bool own = is_own(ordered.op);
    if (own) {
      if (OwnEdit* held = own_.find(ordered.op.seq)) {
        if (!held->decided) ++counters_.own_confirmed;
        held->decided = true;
        held->asked = held->unseen = false;
        held->version = version;
        if (version.seq <= durable_) settle_own();
      }
      news_of(*shared_info(), arrival.now_us);
    }
    for (std::size_t c = 0; c < chunks.size(); ++c) {
      const ChunkKey key{0, chunks[c]};
      if (!view_ || !view_->contains(key.at)) continue;
      Entry& entry = entry_for(key);
      entry.latest = std::max(entry.latest, version.seq);
      if (own) {
        for (Pending& pending : entry.pending) {
          if (pending.seq == ordered.op.seq) pending.decided_at = version.seq;
        }
      }
      entry.inbox.push_back({shared_info(), ordered.previous[c]});
      if (!entry.current || entry.awaiting) {
        ++counters_.chunk_edits_buffered;
        if (entry.inbox.size() > kInboxEditsMax) {
          // Whoever falls this far behind is served by a newer snapshot: `latest` remembers what it must
          // contain.
          entry.inbox.clear();
          ++counters_.buffer_overflows;
        }
      }
      touched_entries[key] = &entry;
    }
  }
  for (const auto& [key, entry] : touched_entries) settle(key, *entry, false, arrival.now_us);
  return {};
}

void Replica::receive(const Reject& reject, TimeUs now_us) {
  OwnEdit* own = own_.find(reject.client_seq);
  if (own == nullptr || (own->decided && !own->asked)) return;  // applied after all, or taken back before
  const bool decided_unseen = reject.reason == RejectReason::already_decided;
  for (const ChunkKey& key : own->chunks) {
    const auto it = entries_.find(key);
    if (it == entries_.end()) continue;
    Entry& entry = it->second;
    if (decided_unseen) {
      for (Pending& pending : entry.pending) {
        if (pending.seq == reject.client_seq) pending.until_snapshot = true;
      }
      // Its commit never reached us, so this copy may lack it; after a resumption every chunk comes anew
      // anyway.
      if (entry.confirmed && !own->asked) request(key, entry, now_us);
      continue;
    }
    const auto removed =
        std::erase_if(entry.pending, [&](const Pending& p) { return p.seq == reject.client_seq; });
    if (removed != 0 && entry.confirmed) show(key, entry, predict(key, entry), {});
  }
  if (decided_unseen) {
    own->decided = own->unseen = true;
    own->asked = false;
    own->version = {opening_->epoch, reject.seq != 0 ? reject.seq : newest_};
    return settle_own();
  }
  own_.erase(reject.client_seq);
  ++counters_.own_rejected;
  reject_news_.push_back({reject.client_seq, reject.reason, reject.detail});
}

void Replica::receive(const Durable& durable) {
  if (!opening_ || durable.epoch != opening_->epoch) return;
  durable_ = std::max(durable_, durable.seq);
  newest_ = std::max(newest_, durable.seq);
  settle_own();
}

void Replica::settle_own() {
  const auto settled = own_.take_durable(durable_);
  durable_news_.insert(durable_news_.end(), settled.durable.begin(), settled.durable.end());
  counters_.own_durable += settled.durable.size();
  unseen_news_.insert(unseen_news_.end(), settled.unseen.begin(), settled.unseen.end());
}

void Replica::receive(const Audit& audit, TimeUs now_us) {
  for (const AuditEntry& theirs : audit.entries) {
    const auto it = entries_.find(theirs.key);
    if (it == entries_.end() || !it->second.confirmed || it->second.awaiting) continue;
    const Chunk& ours = *it->second.confirmed;
    if (ours.version != theirs.version) continue;
    ++counters_.audited;
    // From the runs, not from the digest that followed the edits: the runs are what is meshed.
    if (digest_of(ours.voxels) == theirs.digest) continue;
    ++counters_.drifted;
    request(theirs.key, it->second, now_us);
  }
}

void Replica::tick(TimeUs now_us) {
  for (auto& [key, entry] : entries_) {
    if (entry.awaiting && now_us - *entry.requested_us >= kRequestAgainUs) request(key, entry, now_us);
  }
}

// ---- one chunk
// -------------------------------------------------------------------------------------------------

/// Applies what the inbox holds in order, asks for a snapshot at a gap, and shows the outcome.
void Replica::settle(const ChunkKey& key, Entry& entry, bool from_snapshot, TimeUs now_us) {
  if (!entry.confirmed || entry.awaiting) return;
  Version version = entry.confirmed->version;
  std::vector<EditDescriptor> stack;
  std::vector<EditNews*> cause;
  std::size_t taken = 0;
  for (; taken < entry.inbox.size(); ++taken) {
    const Inbound& inbound = entry.inbox[taken];
    const EditInfo& info = *inbound.info;
    const bool contained = info.version.seq <= version.seq;
    if (!contained && inbound.previous != version.seq) break;
    if (contained) {
      ++counters_.chunk_edits_contained;
    } else {
      stack.push_back(info.edit);
      version = info.version;
      ++counters_.chunk_edits_applied;
    }
    if (!contained || from_snapshot) {
      EditNews& news = news_of(info, now_us);
      news.in_snapshot = news.in_snapshot || contained;
      cause.push_back(&news);
    }
    if (is_own(info.op)) {
      std::erase_if(entry.pending, [&](const Pending& p) { return p.seq == info.op.seq; });
    }
  }
  entry.inbox.erase(entry.inbox.begin(), entry.inbox.begin() + static_cast<std::ptrdiff_t>(taken));
  if (!stack.empty()) {
    auto next = std::make_shared<Chunk>(*entry.confirmed);
    apply_stack(next->voxels, next->digest, origin(key), stack, scratch_);
    next->version = version;
    entry.confirmed = std::move(next);
  }
  // Without a snapshot of this connection a gap is no surprise: it was overtaken, and closes what is missing.
  if (entry.latest > version.seq && entry.current) {
    ++counters_.gaps;
    // A snapshot that still leaves a gap was taken too early; the next one is asked for after a pause, by
    // tick().
    if (from_snapshot && entry.requested_us && now_us - *entry.requested_us < kRequestAgainUs) {
      entry.awaiting = true;
    } else {
      request(key, entry, now_us);
    }
  }
  show(key, entry, predict(key, entry), cause);
}

void Replica::request(const ChunkKey& key, Entry& entry, TimeUs now_us) {
  entry.awaiting = true;
  entry.requested_us = now_us;
  const auto place = std::lower_bound(requests_.begin(), requests_.end(), key);
  if (place != requests_.end() && *place == key) return;
  requests_.insert(place, key);
  ++counters_.requests;
}

/// Replaces the shown runs, and tells the mesher if any voxel differs.
void Replica::show(const ChunkKey& key, Entry& entry, ShownPtr next, const std::vector<EditNews*>& cause) {
  const bool whole = entry.shown == nullptr;
  const Extent extent = next->extent;
  const DirtyLayers dirty = whole                 ? all_layers(extent)
                            : entry.shown == next ? DirtyLayers{}
                                                  : changed_layers(*entry.shown, *next);
  entry.shown = std::move(next);
  if (!dirty.any()) return;
  entry.serial = ++last_serial_;

  const auto tell = [&](ChunkNews& news) {
    for (EditNews* edit : cause) {
      if (std::find(edit->chunks.begin(), edit->chunks.end(), news.key) == edit->chunks.end()) {
        edit->chunks.push_back(news.key);
      }
      if (news.edits.empty() || news.edits.back() != edit->op) news.edits.push_back(edit->op);
    }
  };
  ChunkNews& own = chunk_news(key);
  own.serial = entry.serial;
  own.dirty |= dirty;
  own.whole = own.whole || whole;
  own.removed = false;
  tell(own);
  if (whole)
    return;  // the neighbours learn of a new chunk by its news: whether they waited for it is theirs to know
  for (int i = 0; i < kDirectionCount; ++i) {
    const auto d = static_cast<Direction>(i);
    if (!border_dirty(dirty, d, extent.sides()[static_cast<std::size_t>(axis_of(d))])) continue;
    const ChunkKey next_key{key.lod, neighbour(key.at, d)};
    const auto it = entries_.find(next_key);
    if (it == entries_.end() || !it->second.shown) continue;
    ChunkNews& border = chunk_news(next_key);
    it->second.serial = ++last_serial_;
    border.serial = it->second.serial;
    border.borders = static_cast<std::uint8_t>(border.borders | 1U << static_cast<unsigned>(opposite(d)));
    tell(border);
  }
}

// ---- news
// ------------------------------------------------------------------------------------------------------

ChunkNews& Replica::chunk_news(const ChunkKey& key) {
  ChunkNews& news = chunk_news_[key];
  news.key = key;
  return news;
}

EditNews& Replica::news_of(const EditInfo& info, TimeUs now_us) {
  EditNews*& slot = confirmed_news_[info.op];
  if (slot == nullptr) {
    auto news = std::make_unique<EditNews>();
    news->op = info.op;
    news->seq = info.version.seq;
    news->own = is_own(info.op);
    news->submitted_us = info.submitted_us;
    news->ordered_us = info.ordered_us;
    news->received_us = info.received_us;
    news->unpacked_us = info.unpacked_us;
    news->applied_us = now_us;
    slot = news.get();
    edit_news_.push_back(std::move(news));
  }
  return *slot;
}

ReplicaNews Replica::take_news() {
  ReplicaNews news;
  news.chunks.reserve(chunk_news_.size());
  for (auto& [key, chunk] : chunk_news_) news.chunks.push_back(std::move(chunk));
  news.edits.reserve(edit_news_.size());
  for (auto& edit : edit_news_) news.edits.push_back(std::move(*edit));
  news.rejects = std::exchange(reject_news_, {});
  news.durable = std::exchange(durable_news_, {});
  news.unseen = std::exchange(unseen_news_, {});
  chunk_news_.clear();
  edit_news_.clear();
  confirmed_news_.clear();
  return news;
}

std::vector<ChunkKey> Replica::take_requests() { return std::exchange(requests_, {}); }

// ---- reading
// ---------------------------------------------------------------------------------------------------

ChunkPtr Replica::confirmed(const ChunkKey& key) const {
  const auto it = entries_.find(key);
  return it == entries_.end() ? nullptr : it->second.confirmed;
}

ShownPtr Replica::shown(const ChunkKey& key) const {
  const auto it = entries_.find(key);
  return it == entries_.end() ? nullptr : it->second.shown;
}

std::uint64_t Replica::shown_serial(const ChunkKey& key) const {
  const auto it = entries_.find(key);
  return it == entries_.end() ? 0 : it->second.serial;
}

std::optional<Material> Replica::shown_at(VoxelPos at) const {
  if (!opening_) return std::nullopt;
  const ShownPtr chunk = shown({0, chunk_of(at, opening_->chunk_edge)});
  if (!chunk) return std::nullopt;
  return material_at(*chunk, local_of(at, opening_->chunk_edge));
}

std::vector<ChunkKey> Replica::confirmed_keys() const {
  std::vector<ChunkKey> keys;
  keys.reserve(confirmed_count_);
  for (const auto& [key, entry] : entries_) {
    if (entry.confirmed) keys.push_back(key);
  }
  return keys;
}

std::size_t Replica::awaiting_count() const {
  return static_cast<std::size_t>(
      std::count_if(entries_.begin(), entries_.end(), [](const auto& e) { return e.second.awaiting; }));
}

}  // namespace runstone
