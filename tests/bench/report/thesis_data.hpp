// ThesisData: the thesis' results, from its tables thesis_results.csv and chunk_sizes.csv, which
// were made from its raw logs (tests/data/thesis).
#pragma once
#include <map>
#include <string>
#include <string_view>
#include <tuple>

namespace runstone::bench {

class ThesisData {
 public:
  /// Reads the tables. A table that cannot be read is empty; doubt() names it.
  static ThesisData read(const std::string& folder);

  /// `mesher` is Grid, RLE or VoxelPlugin. Returns NaN where the thesis has no figure. Values that
  /// the thesis' data contradict are included: kThesisDefects lists them.
  double value(unsigned scenario, std::string_view mesher, std::string_view metric) const;
  /// Returns the mean time of a chunk of that edge, in ms.
  double chunk_size_ms(unsigned scenario, unsigned side, std::string_view mesher) const;

  /// Returns an empty text if everything was read.
  const std::string& doubt() const { return doubt_; }

 private:
  std::map<std::tuple<unsigned, std::string, std::string>, double, std::less<>> results_;
  std::map<std::tuple<unsigned, unsigned, std::string>, double, std::less<>> sizes_;
  std::string doubt_;
};

/// A known defect of the thesis' data, in one sentence. The golden tests read the same data
/// (docs/reproduce.md).
struct ThesisDefect {
  unsigned scenario;
  const char* what;
};
inline constexpr ThesisDefect kThesisDefects[] = {
    {12,
     "Its maps pointed at gap count 2 when it was measured: its figures are those of scenario 10."},
    {18,
     "Threads shared one random stream: only the centre chunk can be made again. "
     "Voxel Plugin's time is ten times the usual per vertex, likely another model's."},
    {19, "Threads shared one random stream: only the centre chunk can be made again."},
    {20, "Threads shared one random stream: only the centre chunk can be made again."},
    {21,
     "Threads shared one random stream: only the centre chunk can be made again. "
     "The RLE meshing file holds events of other sessions; its phases are left out."},
    {22, "Threads shared one random stream: only the centre chunk can be made again."},
    {28, "The file of RLE's buffer phase holds Voxel Plugin's events; it is left out."},
    {30, "The file of Grid's buffer phase is a copy of RLE's; it is left out."},
    {31, "Voxel Plugin's map pointed at scenario 32: its vertices and times are of that model."},
};
inline constexpr const char* kThesisMeans =
    "The thesis averages by v = round((v + new) / 2), in which the last chunk weighs half; "
    "here its raw events are averaged plainly. Scenarios whose data contradict each other (12, 18, "
    "31) are in these means.";
inline constexpr const char* kVoxelPluginChunks =
    "Voxel Plugin: the mean over its chunks with voxels, "
    "some 27 of the 484 events it logs a scenario; the thesis drew the mean over all events, "
    "about a seventh of that.";
inline constexpr const char* kVoxelPluginEvents =
    "Voxel Plugin: phases are means over all 484 events it logs a scenario, "
    "of which some 27 are chunks with voxels.";

}  // namespace runstone::bench
