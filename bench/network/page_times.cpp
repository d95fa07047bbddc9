#include "bench/network/page_times.hpp"

#include <algorithm>

#include "bench/harness/statistics.hpp"

namespace runstone::bench {

double PageTimes::p99_ms() const { return std::max(pages[0].p99_ms, pages[1].p99_ms); }

bool PageTimes::is_complete() const {
  return std::all_of(pages.begin(), pages.end(),
                     [](const Page& page) { return page.answers > 0 && page.failed == 0; });
}

PageTimes::Page page_times(const PageProbe::Answers& answers) {
  PageTimes::Page out;
  out.answers = answers.ms.size();
  out.failed = answers.failed;
  if (answers.ms.empty()) return out;
  out.p50_ms = quantile(answers.ms, 0.5);
  out.p99_ms = quantile(answers.ms, 0.99);
  out.max_ms = quantile(answers.ms, 1);
  return out;
}

}  // namespace runstone::bench
