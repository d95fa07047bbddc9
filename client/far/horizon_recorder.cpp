#include "client/far/horizon_recorder.hpp"

#include "common/core/assert.hpp"

namespace runstone {

void HorizonRecorder::look(const FarTiles& tiles, bool is_meshed, TimeUs now_us) {
  RUNSTONE_ASSERT(is_open());
  const FarTiles::Missing missing = tiles.missing();
  if (missing.roots == 0 && !report_.coarse_us) report_.coarse_us = now_us - *began_us_;
  if (missing.roots + missing.others == 0 && is_meshed) report_.all_us = now_us - *began_us_;
}

}  // namespace runstone
