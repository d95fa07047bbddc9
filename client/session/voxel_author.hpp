// VoxelAuthor: who set the voxel at the crosshair last, and when. It decides when the server is
// asked: once the crosshair rests, one request at a time, at most one a second. Answers are kept.
// Pure: times are arguments, in microseconds of the client's steady clock. One thread.
#pragma once
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <utility>

#include "protocol/codec/messages.hpp"

namespace runstone {

class VoxelAuthor {
 public:
  /// A voxel in sight: what is shown there, and the version of its chunk.
  struct Sight {
    VoxelPos at;
    Material material = kEmpty;
    Version version;
    friend bool operator==(const Sight&, const Sight&) = default;
  };
  /// The record that set a voxel last.
  struct Found {
    LogMark mark;
    std::string author;  // its name; "the server", or "#N" if it is not known
  };

  /// The crosshair rests on a voxel for this time before the server is asked.
  static constexpr TimeUs kRestUs = 500'000;
  static constexpr TimeUs kEveryUs = 1'000'000;
  /// An answer that has not arrived within this time counts as lost.
  static constexpr TimeUs kAnswerUsMax = 10'000'000;
  static constexpr std::size_t kKeptMax = 64;  // answers
  /// The first number of a request, behind those of LogTimeline.
  static constexpr std::uint32_t kFirstRequest = std::uint32_t{1} << 31;

  /// Takes the voxel in sight, or nullopt if there is none or the server cannot know it yet. Returns
  /// the request to send now, or nullopt. `may_send`: nothing else is asked about the log.
  std::optional<LogMarksRequest> look(const std::optional<Sight>& sight, bool may_send,
                                      TimeUs now_us);
  /// Takes an answer of the server. Returns false if it is no answer to the request under way.
  bool receive(const LogMarks& marks);
  /// Returns true if a request is under way.
  bool is_waiting() const { return pending_.has_value(); }
  /// Forgets the request under way, because its connection ended.
  void disconnected() { pending_.reset(); }
  /// Forgets everything, because the next world is another one.
  void clear() { *this = {}; }

  /// Returns the record for the voxel in sight, or null if it is not known or there is none. An
  /// answer stays while the material does, also if the chunk has a newer version.
  const Found* found() const;
  /// Returns true if found() may return something else than at the last call.
  bool take_changed() { return std::exchange(has_changed_, false); }

 private:
  struct Kept {
    Sight sight;
    std::optional<Found> found;
  };
  struct Pending {
    std::uint32_t request = 0;
    Sight sight;
    TimeUs sent_us = 0;
  };
  const Kept* kept(const Sight& sight) const;

  bool has_changed_ = true;
  std::optional<Sight> sight_;
  TimeUs rests_since_us_ = 0;
  std::optional<TimeUs> sent_us_;
  std::uint32_t next_request_ = kFirstRequest;
  std::optional<Pending> pending_;
  std::deque<Kept> kept_;  // newest first, one for each voxel
};

}  // namespace runstone
