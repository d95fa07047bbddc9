// The contents of a VeilScratch. Internal to veil.
#pragma once
#include "common/runs/run_sink.hpp"
#include "common/veil/enclosed_layers.hpp"
#include "common/veil/veil.hpp"

namespace runstone {

struct VeilScratch::State {
  EnclosedScratch<Row64> narrow;
  EnclosedScratch<Row128> wide;
  RunSink sink;
};

}  // namespace runstone
