#include "bench/network/page_table.hpp"

#include <fmt/format.h>

#include <iterator>

namespace runstone::bench {
namespace {

// The target. A request for the map's state waits until one short step of drawing ends. The threads
// that draw have a low priority.
constexpr double kAddedPageMsMax = 100;

std::string figure_of(const char* page) {
  return std::string(page) == kProbedPages[0] ? "status" : "map_state";
}

}  // namespace

void add_page_figures(const AttackResult& result, std::vector<Figure>& figures) {
  if (!result.has_gateway) return;
  for (const AttackPhase phase : kAttackPhases) {
    figures.push_back({"attack", "loopback", "loopback", result.name,
                       fmt::format("{}_gateway_cores", kAttackPhaseNames[phase]),
                       result.gateway_cores[phase]});
    for (std::size_t i = 0; i < kProbedPages.size(); ++i) {
      const PageTimes::Page& page = result.pages[phase].pages[i];
      const auto add = [&](const char* name, double value) {
        figures.push_back(
            {"attack", "loopback", "loopback", result.name,
             fmt::format("{}_{}_{}", kAttackPhaseNames[phase], figure_of(kProbedPages[i]), name),
             value});
      };
      add("answers", static_cast<double>(page.answers));
      add("failed", static_cast<double>(page.failed));
      add("p50_ms", page.p50_ms);
      add("p99_ms", page.p99_ms);
      add("max_ms", page.max_ms);
    }
  }
}

void add_page_targets(std::span<const AttackResult> results, std::vector<Target>& targets) {
  for (const AttackResult& result : results) {
    if (!result.has_gateway) continue;
    const double added_ms = result.pages[during].p99_ms() - result.pages[before].p99_ms();
    // Only answers have a time. Without this condition a gateway that answers nothing would be fast.
    const bool is_complete =
        result.pages[before].is_complete() && result.pages[during].is_complete();
    targets.push_back(
        {fmt::format("{}: added to the p99 of an honest reader's pages", result.name),
         fmt::format("at most {} ms", number_text(kAddedPageMsMax)),
         number_text(added_ms) + (is_complete ? " ms" : " ms; some requests failed"),
         is_complete && added_ms <= kAddedPageMsMax ? Verdict::met : Verdict::missed});
  }
}

std::string page_table(std::span<const AttackResult> results) {
  std::string rows;
  const auto times = [](const PageTimes::Page& page) {
    return fmt::format("{}, {}, {}", number_text(page.p50_ms), number_text(page.p99_ms),
                       number_text(page.max_ms));
  };
  for (const AttackResult& result : results) {
    if (!result.has_gateway) continue;
    for (std::size_t i = 0; i < kProbedPages.size(); ++i) {
      std::size_t answers = 0, failed = 0;
      for (const AttackPhase phase : kAttackPhases) {
        answers += result.pages[phase].pages[i].answers;
        failed += result.pages[phase].pages[i].failed;
      }
      fmt::format_to(std::back_inserter(rows),
                     "| {} | {} | {} | {} | {} | {}, {} | {:.2f}, {:.2f} |\n", result.name,
                     kProbedPages[i], times(result.pages[before].pages[i]),
                     times(result.pages[during].pages[i]), times(result.pages[after].pages[i]),
                     answers, failed, result.gateway_cores[before], result.gateway_cores[during]);
    }
  }
  if (rows.empty()) return rows;
  return "\nA gateway with default settings and a map stands before the server. An honest reader asks for "
         "each page twenty times a second; from when a request was due to the whole answer:\n\n"
         "| attack | page | before p50, p99, max ms | during | after | answers, failed | "
         "gateway cores before, during |\n"
         "|---|---|---|---|---|---|---|\n" +
         rows;
}

}  // namespace runstone::bench
