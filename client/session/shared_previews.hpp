// SharedPreviews: the previews that the other players share, and the times at which this player's
// preview is sent. Time is an argument. One thread.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "protocol/codec/preview_messages.hpp"

namespace runstone {

class SharedPreviews {
 public:
  /// Players whose previews are kept. Beyond it, previews of further players are dropped.
  static constexpr std::size_t kAuthorsMax = 64;
  /// A preview is sent at most this often, and again after kRepeatUs while it does not change.
  static constexpr TimeUs kEveryUs = 200'000, kRepeatUs = 2'000'000;
  /// A preview is dropped if no newer one of its player has arrived for this time.
  static constexpr TimeUs kShownUs = 5'000'000;

  struct Shared {
    std::vector<EditDescriptor> edits;  // at least one
    TimeUs received_us = 0;
    std::optional<BrushStroke> stroke = std::nullopt;
    friend bool operator==(const Shared&, const Shared&) = default;
  };

  /// Takes the preview of another player. One that may not be shared (may_be_shared()) counts as
  /// none, and so does a stroke that does not pass check_stroke().
  void receive(PlayerPreview preview, std::int32_t chunk_edge, TimeUs now_us);
  /// Forgets the preview of a player who left.
  void forget(AuthorId author) { others_.erase(author); }
  /// Forgets the preview of a player if it is a stroke, because the player has edited: on the new
  /// ground the stroke would be shown once more. The next preview replaces it soon.
  void forget_stroke(AuthorId author);
  /// Forgets everything, for a new connection.
  void reset();
  /// Forgets previews that are too old.
  void expire(TimeUs now_us);
  const std::map<AuthorId, Shared>& others() const { return others_; }

  /// Takes this player's preview. Returns the message to send now, or nullopt if there is none yet.
  /// A preview that may not be shared counts as none, and so does such a stroke. Call it often.
  /// Cost: O(1) between two messages.
  std::optional<PreviewShare> share(const std::vector<EditDescriptor>& edits,
                                    std::int32_t chunk_edge, TimeUs now_us,
                                    const std::optional<BrushStroke>& stroke = std::nullopt);

 private:
  std::map<AuthorId, Shared> others_;
  PreviewShare sent_;
  std::optional<TimeUs> unfit_us_;  // when a preview was found that may not be shared
  std::optional<TimeUs> sent_us_;   // nullopt: nothing was sent on this connection
};

}  // namespace runstone
