// Views: decides when a session's view takes effect. Only the newest view of a session waits. A
// session's view takes effect at most once in view_interval_us, and on one tick the views of all
// sessions visit at most view_chunks_per_tick chunks: those that they add or leave and those that
// are not sent yet (the last view may exceed it). So a client that moves its view a thousand times
// a second costs the world strand no more than one that moves it twenty times.
//
// Thread: the world strand.
#pragma once
#include "server/world/ground/tiles.hpp"

namespace runstone {

class Views {
 public:
  Views(GroundBase& base, Loads& loads, ChunkSending& sending, Tiles& tiles)
      : base_(base),
        loads_(loads),
        sending_(sending),
        tiles_(tiles),
        chunks_left_(base.config.view_chunks_per_tick) {}

  /// Limits the radii to the server's maximum. Returns true if the view has taken effect and its
  /// chunks are to be delivered; otherwise it takes effect on a later tick. Closes the session if
  /// the numbers of its views do not ascend.
  [[nodiscard]] bool on_view(Viewer& viewer, View view, const Clocks& now);
  /// Applies views that wait, round robin, until the tick's chunks are used up. Call it on every
  /// tick.
  void apply_due(const Clocks& now);

 private:
  bool is_due(const Viewer& viewer, const Clocks& now) const;
  void apply(Viewer& viewer, const Clocks& now);

  GroundBase& base_;
  Loads& loads_;
  ChunkSending& sending_;
  Tiles& tiles_;
  std::size_t chunks_left_;     // that views may still visit on this tick
  bool do_some_wait_ = false;   // some views had to wait for the next tick
  SessionId applied_last_ = 0;  // the session whose view took effect last on a tick
};

}  // namespace runstone
