#include <fmt/format.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/bench/report/chart/bar_chart.hpp"
#include "tests/bench/report/chart/format_value.hpp"
#include "tests/bench/report/chart/frame.hpp"
#include "tests/bench/report/chart/line_chart.hpp"
#include "tests/bench/report/chart/range_chart.hpp"
#include "tests/bench/report/chart/rank_chart.hpp"
#include "tests/bench/report/number_text.hpp"
#include "tests/bench/report/report_figure.hpp"

namespace runstone::bench {
namespace {

using chart::format_value;
using chart::Role;

constexpr std::array<const char*, 5> kProfiles = {"loopback", "lan", "broadband", "mobile",
                                                  "lossy"};

std::vector<std::string> steps_of(const char* experiment) {
  std::vector<std::string> out;
  for (const char* profile : kProfiles) out.push_back(fmt::format("{}-{}", experiment, profile));
  return out;
}

/// Returns all figures unchanged.
DataTable table_of(const Rows& rows) {
  DataTable out{{"link", "case", "figure", "value"}, {}};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Rows row = rows[i];
    out.add({row.text("profile"), row.text("case"), row.text("figure"), row.number("value")});
  }
  return out;
}

ReportFigure bytes(const Evidence& evidence) {
  const Rows rows = evidence.findings.rows("bytes").where("world", "luanti").where("set", "all");
  struct Form {
    const char *form, *name;
    Role role;
  };
  constexpr std::array<Form, 7> kForms = {
      {{"coded", "ours: coded (slow links)", Role::ours},
       {"packed", "ours: packed", Role::ours},
       {"raw", "ours: raw runs", Role::ours},
       {"minecraft", "Minecraft's form + zlib", Role::other},
       {"dense_zstd", "dense + zstd", Role::baseline},
       {"luanti", "Luanti's form + zstd", Role::other},
       {"luanti_light", "the same with its light", Role::other}}};
  chart::RankChart chart;
  chart.x = {"bytes of a chunk of 32³, mean over a real world", false};
  chart.title = "bytes of a chunk";
  for (const Form& form : kForms) {
    const Rows row = rows.where("form", form.form);
    chart.names.push_back(form.name);
    chart.roles.push_back(form.role);
    chart.values.push_back(row.number("bytes"));
    chart.notes.push_back(fmt::format("write {}, read {} µs", format_value(row.number("encode_us")),
                                      format_value(row.number("decode_us"))));
  }
  ReportFigure out;
  out.id = "bytes";
  out.title = "A chunk on the wire";
  const auto of = [&](const char* form) { return rows.where("form", form).number("bytes"); };
  out.sentence = fmt::format(
      "Packed runs take {} % of dense voxels under zstd, {} % of Luanti's form and {} % of "
      "Minecraft's; dense and plain they would be 65,536 bytes.",
      format_value(100 * of("packed") / of("dense_zstd")),
      format_value(100 * of("packed") / of("luanti")),
      format_value(100 * of("packed") / of("minecraft")));
  out.steps = {"bytes"};
  const Rows all = evidence.findings.rows("bytes");
  out.data.columns = {"world", "chunks", "form", "bytes", "encode us", "decode us"};
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Rows row = all[i];
    out.data.add({row.text("world"), row.text("set"), row.text("form"), row.number("bytes"),
                  row.number("encode_us"), row.number("decode_us")});
  }
  out.picture = chart::frame_of(chart);
  return out;
}

ReportFigure transfers(const Evidence& evidence) {
  const auto steps = steps_of("transfer");
  const Rows rows = evidence.findings.figures(steps).where("figure", "complete_ms");
  const std::array<const char*, 5> worlds = {"luanti", "terrain", "caves", "town", "noise"};
  const auto ms = [&](const char* profile, const std::string& what) {
    return rows.where("profile", profile).where("case", what).number("value");
  };
  chart::BarChart chart{
      {}, {}, {"ms until all 64 chunks are meshed, real world", true}, "transfer and mesh"};
  chart.series = {{"packed runs + RDM", Role::ours, {}},
                  {"raw runs + RDM", Role::other, {}},
                  {"dense + zstd + binary greedy", Role::baseline, {}},
                  {"dense + binary greedy", Role::other, {}}};
  const std::array<const char*, 4> forms = {"packed", "raw", "dense_zstd", "dense"};
  std::string ratios;
  for (const char* profile : kProfiles) {
    chart.categories.emplace_back(profile);
    for (std::size_t f = 0; f < forms.size(); ++f) {
      chart.series[f].values.push_back(ms(profile, fmt::format("luanti {}", forms[f])));
    }
    std::vector<double> gains;
    for (const char* world : worlds) {
      gains.push_back(ms(profile, fmt::format("{} dense_zstd", world)) /
                      ms(profile, fmt::format("{} packed", world)));
    }
    const double gain = geometric_mean_of(gains);
    if (!std::isnan(gain))
      ratios += fmt::format("{}{} {}", ratios.empty() ? "" : ", ", profile, format_value(gain));
  }
  ReportFigure out;
  out.id = "transfers";
  out.title = "Send, unpack, mesh: under each link (9.2)";
  out.sentence = fmt::format(
      "Until everything is meshed, dense voxels under zstd take this many times as long as packed "
      "runs (geometric mean of five worlds): {}. On slow links bytes decide, "
      "on fast ones the meshing.",
      ratios.empty() ? "not measured" : ratios);
  out.steps = steps;
  out.data = table_of(evidence.findings.figures(steps));
  out.picture = chart::frame_of(chart);
  return out;
}

ReportFigure latency(const Evidence& evidence) {
  const auto steps = steps_of("latency");
  const Rows rows = evidence.findings.figures(steps);
  chart::RangeChart chart;
  chart.x = {"ms from the click to the mesh", true};
  chart.value_names = {"p50", "p50", "p99", "max"};
  chart.title = "latency";
  const auto add = [&](const char* profile, const char* what, const char* figure,
                       const std::string& name, Role role) {
    const auto value = [&](const char* percentile) {
      return rows.where("profile", profile)
          .where("case", what)
          .where("figure", fmt::format("{}_{}_ms", figure, percentile))
          .number("value");
    };
    chart.names.push_back(name);
    chart.roles.push_back(role);
    chart.ranges.push_back({value("p50"), value("p50"), value("p99"), value("max")});
  };
  for (const char* profile : kProfiles) {
    add(profile, "idle", "local_predicted_meshed", fmt::format("{}: local edit", profile),
        Role::ours);
    add(profile, "idle", "remote_meshed", fmt::format("{}: remote edit", profile), Role::other);
    add(profile, "streaming 20 clients", "remote_meshed",
        fmt::format("{}: beside terrain, 20 clients", profile), Role::baseline);
  }
  ReportFigure out;
  out.id = "latency";
  out.title = "Latency plus mesh, by link";
  const auto p = [&](const char* profile, const char* what, const char* figure) {
    return rows.where("profile", profile)
        .where("case", what)
        .where("figure", figure)
        .number("value");
  };
  out.sentence = fmt::format(
      "The local edit is predicted, so it is meshed after {} ms on loopback and {} on broadband "
      "alike (p50); a remote edit takes the network's delay in addition: {} and {}.",
      format_value(p("loopback", "idle", "local_predicted_meshed_p50_ms")),
      format_value(p("broadband", "idle", "local_predicted_meshed_p50_ms")),
      format_value(p("loopback", "idle", "remote_meshed_p50_ms")),
      format_value(p("broadband", "idle", "remote_meshed_p50_ms")));
  out.steps = steps;
  out.data = table_of(rows);
  out.picture = chart::frame_of(chart);
  return out;
}

ReportFigure fleets(const Evidence& evidence) {
  std::vector<std::string> steps;
  const std::array<unsigned, 5> sizes = {1, 10, 100, 300, 1000};
  for (const unsigned clients : sizes) steps.push_back(fmt::format("crowd-{}", clients));
  const Rows rows = evidence.findings.figures(steps);
  const auto value = [&](unsigned clients, const char* figure) {
    return rows.where("case", fmt::format("{} clients", clients))
        .where("figure", figure)
        .number("value");
  };
  chart::LineChart chart;
  chart.x = {"clients in one place, two edits a second each", true};
  chart.y = {"ms until the others have an edit", true};
  chart.title = "fleets";
  const std::array<std::tuple<const char*, Role, const char*>, 3> lines = {
      {{"p50", Role::ours, "seen_p50_ms"},
       {"p99", Role::baseline, "seen_p99_ms"},
       {"max", Role::other, "seen_max_ms"}}};
  for (const auto& [name, role, figure] : lines) {
    chart::LineSeries line{name, role, {}};
    for (const unsigned clients : sizes) {
      if (clients > 1)
        line.points.push_back({static_cast<double>(clients), value(clients, figure)});
    }
    chart.lines.push_back(std::move(line));
  }
  unsigned most = 1;
  for (const unsigned clients : sizes) {
    const double p99 = value(clients, "seen_p99_ms");
    if (!std::isnan(p99)) most = clients;
  }
  ReportFigure out;
  out.id = "crowds";
  out.title = "Crowds: 1 to 1,000 clients";
  out.sentence = fmt::format(
      "{} clients on one server beside their bots on {} cores see each other's edits after {} ms "
      "(p50), {} (p99); {} samples, {} never arrived, {} disconnects.",
      most, evidence.findings.common() == nullptr ? 0 : evidence.findings.common()->machine.cores,
      format_value(value(most, "seen_p50_ms")), format_value(value(most, "seen_p99_ms")),
      count_text(value(most, "samples")), format_value(value(most, "never")),
      format_value(value(most, "disconnects")));
  out.steps = steps;
  out.data = table_of(rows);
  out.picture = chart::frame_of(chart);
  out.marks = {"A single client has nobody to see its edits; its figures are in the CSV."};
  return out;
}

}  // namespace

ReportSection network_section(const Evidence& evidence) {
  ReportSection out;
  out.title = "Under networked conditions";
  out.introduction =
      "Real programs, simulated links: delay, jitter, rate and loss. "
      "Nothing here was asked of the thesis' prototype.";
  out.figures = {bytes(evidence), transfers(evidence), latency(evidence), fleets(evidence)};
  return out;
}

}  // namespace runstone::bench
