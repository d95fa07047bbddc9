#include "client/schedule/view_pace.hpp"

namespace runstone {

bool ViewPace::step(ChunkCoord from, ChunkCoord to, TimeUs now_us) {
  if (from == to) return false;
  if (stepped_us_ && now_us - *stepped_us_ < kViewEveryUs) return false;
  stepped_us_ = now_us;
  return true;
}

}  // namespace runstone
