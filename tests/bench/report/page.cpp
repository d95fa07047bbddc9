#include "tests/bench/report/page.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>

#include "tests/bench/report/chart/chart_css.hpp"
#include "tests/bench/report/html_text.hpp"
#include "tests/bench/report/page_style.hpp"
#include "tests/bench/report/progress_bar.hpp"
#include "tests/bench/report/report_figure.hpp"
#include "tests/bench/report/step.hpp"
#include "tests/bench/report/summary.hpp"
#include "tests/bench/report/verdicts.hpp"

namespace runstone::bench {
namespace {

Result<void, std::string> write_text_file(const std::string& file, const std::string& text) {
  std::ofstream out(file, std::ios::binary);
  out << text;
  out.flush();
  if (!out) return Unexpected<std::string>{"cannot write " + file};
  return {};
}

/// Returns the address of a link that contains its file.
std::string data_uri(const std::string& csv) {
  std::string out = "data:text/csv;charset=utf-8,";
  for (const char c : csv) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_plain = (byte >= '0' && byte <= '9') || (byte >= 'a' && byte <= 'z') ||
                          (byte >= 'A' && byte <= 'Z') || c == '.' || c == '-' || c == '_';
    out += is_plain ? std::string(1, c) : fmt::format("%{:02X}", byte);
  }
  return out;
}

std::string paragraphs(const char* css_class, const std::vector<std::string>& texts) {
  std::string out;
  for (const std::string& text : texts)
    out += fmt::format("<p class=\"{}\">{}</p>\n", css_class, html_text(text));
  return out;
}

std::string html_of(const ReportFigure& figure, const Findings& findings) {
  std::string out =
      fmt::format("<figure id=\"{}\">\n<h3>{}</h3>\n", figure.id, html_text(figure.title));
  const auto doubts = findings.doubts(figure.steps);
  if (findings.is_missing(figure.steps)) {
    return out + paragraphs("doubt", doubts) + "</figure>\n";
  }
  out += fmt::format("<figcaption><p>{}</p></figcaption>\n", html_text(figure.sentence));
  out += paragraphs("doubt", doubts);
  out += figure.picture + "\n";
  if (!figure.marks.empty()) {
    out += "<details><summary>What to know about these data</summary>\n" +
           paragraphs("quiet", figure.marks) + "</details>\n";
  }
  const std::string csv = csv_of(figure.data);
  out += fmt::format(
      "<p class=\"quiet csv\"><a download=\"{}.csv\" href=\"{}\">Data as CSV</a></p>\n</figure>\n",
      figure.id, data_uri(csv));
  return out;
}

std::string html_of(const Verdicts& verdicts, const Findings& findings) {
  std::string out = fmt::format("<p class=\"answer\">{}</p>\n", html_text(verdicts.answer)) +
                    paragraphs("doubt", findings.doubts(verdicts.steps));
  if (verdicts.rows.empty()) return out;
  out +=
      "<table class=\"verdicts\"><thead>"
      "<tr><th>Question</th><th>Wins</th><th>Loses</th></tr></thead><tbody>\n";
  for (const ReportVerdict& row : verdicts.rows) {
    out += fmt::format(
        "<tr><td><a href=\"#{}\">{}</a></td><td data-head=\"wins\">{}</td><td "
        "data-head=\"loses\">{}</td></tr>\n",
        row.figure, html_text(row.question), html_text(row.winner), html_text(row.loser));
  }
  return out + "</tbody></table>\n";
}

std::string provenance(const Findings& findings) {
  const Finding* common = findings.common();
  if (common == nullptr) return "<p class=\"doubt\">Nothing was measured yet.</p>\n";
  const Machine& m = common->machine;
  return fmt::format(
      "<p class=\"quiet\">{}, {} cores; {}; vectors {}; commit {}; real world {}; {}. Medians; "
      "the machine may be shared.</p>\n",
      html_text(m.cpu), m.cores, html_text(m.compiler), html_text(m.simd), html_text(m.commit),
      html_text(common->luanti),
      common->is_quick ? "a quick run: few repetitions, wide errors" : "a full run");
}

std::string steps_table(const std::vector<Step>& steps, const Findings& findings) {
  std::string out =
      "<h2 id=\"steps\">What was run</h2>\n"
      "<table><thead><tr><th>Step</th><th>Took</th><th>Alone</th></tr></thead><tbody>\n";
  double sum = 0;
  for (const Step& step : steps) {
    const Finding* finding = findings.find(step.name);
    if (finding != nullptr) sum += finding->seconds;
    out += fmt::format(
        "<tr><td>{}</td><td>{}</td><td><code>{}</code></td></tr>\n", html_text(step.name),
        finding == nullptr ? "not measured" : duration_text(finding->seconds),
        html_text("runstone-bench " +
                  (step.command.empty() ? "report --steps " + step.name : step.command)));
  }
  return out +
         fmt::format("</tbody></table>\n<p class=\"quiet\">{} in all.</p>\n", duration_text(sum));
}

}  // namespace

Result<WrittenPage, std::string> write_page(const ReportOptions& options,
                                            const StepFailures& failures) {
  const std::vector<Step> steps = report_steps(options);
  std::vector<std::string> names;
  for (const Step& step : steps) names.push_back(step.name);
  const Findings findings = Findings::read(options.out, names, failures);
  const ThesisData thesis = ThesisData::read(options.thesis);
  const Evidence evidence{findings, thesis};
  const std::vector<ReportSection> sections = {thesis_section(evidence), field_section(evidence),
                                               drawing_section(evidence), beyond_section(evidence),
                                               network_section(evidence)};
  std::error_code error;
  std::filesystem::create_directories(options.out + "/csv", error);
  WrittenPage out{options.out + "/index.html", 0, 0};
  std::string nav = "<nav>", body;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const ReportSection& section = sections[i];
    nav += fmt::format("<a href=\"#part{}\">{}</a> ", i + 1, html_text(section.title));
    body += fmt::format("<h2 id=\"part{}\">{}</h2>\n<p class=\"quiet\">{}</p>\n", i + 1,
                        html_text(section.title), html_text(section.introduction));
    for (const ReportFigure& figure : section.figures) {
      ++out.figures;
      const std::string csv_file = fmt::format("{}/csv/{}.csv", options.out, figure.id);
      body += html_of(figure, findings);
      if (findings.is_missing(figure.steps)) {
        ++out.missing;
        std::filesystem::remove(csv_file, error);  // of an earlier page
      } else if (const auto done = write_text_file(csv_file, csv_of(figure.data)); !done) {
        return Unexpected<std::string>{done.error()};
      }
    }
  }
  nav += "<a href=\"#steps\">What was run</a></nav>\n";
  const std::string thesis_doubt =
      thesis.doubt().empty()
          ? ""
          : paragraphs("doubt", {"The thesis' figures are missing: " + thesis.doubt()});
  const std::string page = fmt::format(
      "<!doctype html>\n"
      "<html lang=\"en\">\n"
      "<head>\n"
      "<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n"
      "<meta name=\"color-scheme\" content=\"light dark\">\n"
      "<title>Runstone: the evaluation</title>\n"
      "<style>\n"
      "{}\n"
      "{}</style>\n"
      "</head>\n"
      "<body>\n"
      "<h1>Meshing voxels from compressed runs: the evaluation</h1>\n"
      "{}{}{}{}{}{}</body>\n"
      "</html>\n",
      chart::chart_css(), kPageStyle, provenance(findings), thesis_doubt,
      html_of(verdicts_of(evidence), findings), nav, body, steps_table(steps, findings));
  if (const auto done = write_text_file(out.file, page); !done)
    return Unexpected<std::string>{done.error()};
  if (const auto done = write_text_file(options.out + "/summary.md", summary_of(evidence)); !done) {
    return Unexpected<std::string>{done.error()};
  }
  return out;
}

}  // namespace runstone::bench
