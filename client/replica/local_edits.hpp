// LocalEdits: this client's edits from the click until they are known to be on disk (invariant 5).
//   sent    -> the server has not answered yet; it is predicted on every chunk it touches
//   decided -> applied at `version`; not predicted, kept to be offered again should the server lose it
// Rejected and durable edits leave. Client sequences are handed out here, from 1, without gaps.
#pragma once
#include <cstdint>
#include <map>
#include <vector>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"

namespace runstone {

/// Own edits held at once; further ones are refused by submit() until the server catches up.
inline constexpr std::size_t kLocalEditsMax = 16384;

struct OwnEdit {
  EditDescriptor edit;
  TimeUs submitted_us =
      0;  // this client's steady clock: the click, or the time it was scheduled for
  TimeUs sent_us = kNever;       // last put on the wire
  std::vector<ChunkKey> chunks;  // touched, in touched_chunks() order
  bool resolved = false;
  Version version;      // once decided; an upper bound when the commit itself was missed
  bool asked = false;   // decided, says the server's mark, but not how: it is sent again to ask
  bool unseen = false;  // its commit never reached us
  static constexpr TimeUs kNever = INT64_MIN;
};

class LocalEdits {
 public:
  using Map = std::map<ClientSequence, OwnEdit>;

  /// Takes the next client sequence. Requires !full().
  ClientSequence add(OwnEdit edit);
  bool full() const { return edits_.size() >= kLocalEditsMax; }
  OwnEdit* find(ClientSequence seq);
  void erase(ClientSequence seq) { edits_.erase(seq); }
  void clear() { edits_.clear(); }

  /// Removes decided edits at or below the watermark; the caller learns their sequences, ascending.
  struct Settled {
    std::vector<ClientSequence> durable;  // their commits were seen
    std::vector<ClientSequence> unseen;   // applied for all we know; the chunks tell
  };
  Settled take_durable(Sequence durable);

  /// A new connection: `decided` is the highest client sequence the server has decided. Edits above it were
  /// lost, even if we saw them applied, and are to be offered again: they are returned, ascending. Edits up
  /// to it whose answer we missed become `asked`.
  std::vector<ClientSequence> resume(ClientSequence resolved);

  /// Edits to be sent (again): undecided ones, and those that ask how they were decided. Ascending.
  std::vector<ClientSequence> unanswered() const;

  const Map& all() const { return edits_; }
  std::size_t undecided() const;

 private:
  Map edits_;
  ClientSequence last_ = 0;
};

}  // namespace runstone
