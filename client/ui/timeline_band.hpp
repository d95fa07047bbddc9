// TimelineBand: the log as a band of coloured segments, with one colour for each author, dates
// below and a legend. One thread.
#pragma once
#include <optional>
#include <vector>

#include "client/ui/hud_state.hpp"

namespace runstone {

/// A piece of the band: records of one author.
struct BandSegment {
  Sequence first = 0, last = 0;  // the marks in it; the band is filled up to the next segment
  AuthorId author = 0;
  friend bool operator==(const BandSegment&, const BandSegment&) = default;
};

/// Joins neighbouring marks of the same author. Requires marks that ascend.
std::vector<BandSegment> band_segments(const std::vector<LogMark>& marks);
/// Returns the authors of the marks, those with many marks first, `count_max` at most.
std::vector<AuthorId> band_authors(const std::vector<LogMark>& marks, std::size_t count_max);

/// Makes the band with ImGui, as wide as the window. Returns the edit that the user clicked.
std::optional<Sequence> build_band(const TimelineState& state, double scale);
/// Makes the names of the authors in their colours.
void build_legend(const TimelineState& state);

}  // namespace runstone
