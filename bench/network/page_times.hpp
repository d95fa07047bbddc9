// PageTimes: how long the gateway's pages took for an honest reader.
#pragma once
#include <array>
#include <cstddef>

#include "bench/network/page_probe.hpp"

namespace runstone::bench {

inline constexpr std::array<const char*, 2> kProbedPages = {"/status", "/map/state.json"};

struct PageTimes {
  struct Page {
    std::size_t answers = 0, failed = 0;
    double p50_ms = 0, p99_ms = 0, max_ms = 0;
  };
  std::array<Page, kProbedPages.size()> pages;  // in the order of kProbedPages

  /// Returns the p99 of the slower page in ms.
  double p99_ms() const;
  /// Returns true if each page was requested, and every request was answered.
  bool is_complete() const;
};

PageTimes::Page page_times(const PageProbe::Answers& answers);

}  // namespace runstone::bench
