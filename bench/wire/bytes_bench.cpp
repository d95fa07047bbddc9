#include "bench/wire/bytes_bench.hpp"

#include <fmt/ostream.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>

#include "bench/harness/clocks.hpp"
#include "bench/harness/statistics.hpp"
#include "bench/harness/target_json.hpp"
#include "bench/wire/transfer_form.hpp"
#include "bench/worlds/lit_chunk.hpp"

namespace runstone::bench {
namespace {

/// The measurement of one chunk in one form.
struct Sample {
  double bytes = 0, encode_us = 0, decode_us = 0;
};
using FormSamples = std::map<std::string_view, Sample>;  // by form

void hold_to(const LitChunk& chunk, const TransferForm& form, std::ostream& progress) {
  const auto light = form.light();
  if (form.voxels() == chunk.voxels && (light.empty() || light == chunk.light)) return;
  fmt::print(progress, "runstone-bench: {} does not come back as it went\n", form.name);
  progress.flush();
  std::abort();
}

template <class Work>
double us_of(Work&& work) {
  const std::uint64_t start = now_ns();
  work();
  return static_cast<double>(now_ns() - start) / 1000;
}

/// Measures the forms in alternation, so that noise of the machine affects all of them alike.
FormSamples measure(const LitChunk& chunk, unsigned repetitions, std::ostream& progress) {
  const std::vector<TransferForm> forms = make_transfer_forms(chunk);
  std::vector<std::vector<double>> encode(forms.size()), decode(forms.size());
  for (const TransferForm& form : forms) {
    form.encode();
    form.decode();
    hold_to(chunk, form, progress);
  }
  for (unsigned i = 0; i < repetitions; ++i) {
    for (std::size_t f = 0; f < forms.size(); ++f) {
      encode[f].push_back(us_of(forms[f].encode));
      decode[f].push_back(us_of(forms[f].decode));
    }
  }
  FormSamples out;
  for (std::size_t f = 0; f < forms.size(); ++f) {
    out[forms[f].name] = {static_cast<double>(forms[f].bytes()), median(encode[f]),
                          median(decode[f])};
  }
  return out;
}

BytesRow row_of(const std::string& world, std::string_view form, bool mixed,
                const std::vector<FormSamples>& chunks) {
  BytesRow row;
  row.world = world;
  row.form = form;
  row.mixed = mixed;
  row.chunks = chunks.size();
  double luanti = 0, minecraft = 0;
  std::vector<double> ratios;
  for (const FormSamples& chunk : chunks) {
    const Sample& sample = chunk.at(form);
    row.bytes += sample.bytes;
    row.encode_us += sample.encode_us;
    row.decode_us += sample.decode_us;
    luanti += chunk.at("luanti_light").bytes;
    minecraft += chunk.at("minecraft").bytes;
    ratios.push_back(sample.bytes / chunk.at("luanti_light").bytes);
  }
  row.of_luanti = row.bytes / luanti;
  row.of_luanti_mean = geometric_mean(ratios);
  row.of_minecraft = row.bytes / minecraft;
  const auto count = static_cast<double>(chunks.size());
  row.bytes /= count;
  row.encode_us /= count;
  row.decode_us /= count;
  return row;
}

void add_rows(const ByteWorld& world, unsigned repetitions, std::vector<BytesRow>& rows,
              std::ostream& progress) {
  std::vector<FormSamples> all, mixed;
  for (const LitChunk& chunk : world.chunks) {
    all.push_back(measure(chunk, repetitions, progress));
    if (!chunk.runs.is_uniform()) mixed.push_back(all.back());
  }
  for (const bool only_mixed : {false, true}) {
    const std::vector<FormSamples>& chunks = only_mixed ? mixed : all;
    if (chunks.empty() || (only_mixed && mixed.size() == all.size())) continue;
    for (const std::string_view form : transfer_form_names()) {
      rows.push_back(row_of(world.name, form, only_mixed, chunks));
    }
  }
}

/// Judges a target, which applies to all chunks and to the non-uniform ones alone.
Target judged(const std::vector<BytesRow>& rows, const std::string& what, const std::string& world,
              const std::string& form, double BytesRow::* ratio, double wanted) {
  Target target{what, fmt::format("{:.2f}x", wanted), "", Verdict::not_measured};
  bool met = true;
  for (const BytesRow& row : rows) {
    if (row.world != world || row.form != form) continue;
    target.measured += fmt::format("{}{:.3f}x {}", target.measured.empty() ? "" : "; ", row.*ratio,
                                   row.mixed ? "without uniform chunks" : "of all chunks");
    met = met && row.*ratio <= wanted;
  }
  if (!target.measured.empty()) target.verdict = met ? Verdict::met : Verdict::missed;
  return target;
}

/// The stretch targets apply to the best coder only.
std::vector<Target> targets_of(const std::vector<BytesRow>& rows) {
  const auto luanti = &BytesRow::of_luanti, minecraft = &BytesRow::of_minecraft;
  std::vector<Target> targets;
  for (const char* form : {"packed", "coded"}) {
    const auto add = [&](const char* what, const char* world, double BytesRow::* ratio,
                         double wanted) {
      targets.push_back(
          judged(rows, fmt::format(fmt::runtime(what), form), world, form, ratio, wanted));
    };
    add("noise terrain, {} against Luanti's layout with light", "noise_terrain", luanti, 0.35);
    add("real world, {} against Luanti's layout with light", "luanti", luanti, 0.48);
    add("real world, {} against Minecraft's palette + zlib", "luanti", minecraft, 0.90);
  }
  targets.push_back(judged(rows, "real world, coded against Luanti's layout with light: stretch",
                           "luanti", "coded", luanti, 0.38));
  targets.push_back(judged(rows, "real world, coded against Minecraft's palette + zlib: stretch",
                           "luanti", "coded", minecraft, 0.70));
  return targets;
}

}  // namespace

Result<BytesBench, std::string> run_bytes_bench(const BenchOptions& options,
                                                std::ostream& progress) {
  BytesBench out;
  out.machine = this_machine();
  out.repetitions = options.repetitions;
  for (const std::string& name : byte_world_names()) {
    const auto& wanted = options.worlds;
    if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), name) == wanted.end()) continue;
    const auto world = byte_world(name, options.luanti);
    if (!world) return failure(world.error());
    add_rows(*world, options.repetitions, out.rows, progress);
    fmt::print(progress, "{}\n", name);
    progress.flush();
  }
  out.targets = targets_of(out.rows);
  return out;
}

void write_table(const BytesBench& bench, std::ostream& out) {
  fmt::print(out,
             "\n| world | chunks | form | bytes | x Luanti with light | geometric mean | "
             "x Minecraft | encode µs | decode µs |\n"
             "|---|---|---|---|---|---|---|---|---|\n");
  for (const BytesRow& row : bench.rows) {
    fmt::print(out, "| {} | {} {} | {} | {:.0f} | {:.3f} | {:.3f} | {:.3f} | {:.1f} | {:.1f} |\n",
               row.world, row.chunks, row.mixed ? "not uniform" : "all", row.form, row.bytes,
               row.of_luanti, row.of_luanti_mean, row.of_minecraft, row.encode_us, row.decode_us);
  }
  fmt::print(out, "\n");
  write_targets(bench.targets, out);
}

void write_csv(const BytesBench& bench, std::ostream& out) {
  fmt::print(out,
             "world,chunks,set,form,bytes,of_luanti,of_luanti_geometric,of_minecraft,encode_us,"
             "decode_us\n");
  for (const BytesRow& row : bench.rows) {
    fmt::print(out, "{},{},{},{},{:.2f},{:.5f},{:.5f},{:.5f},{:.3f},{:.3f}\n", row.world,
               row.chunks, row.mixed ? "mixed" : "all", row.form, row.bytes, row.of_luanti,
               row.of_luanti_mean, row.of_minecraft, row.encode_us, row.decode_us);
  }
}

void write_json(const BytesBench& bench, std::ostream& out) {
  auto rows = nlohmann::ordered_json::array();
  for (const BytesRow& row : bench.rows) {
    rows.push_back({{"world", row.world},
                    {"chunks", row.chunks},
                    {"set", row.mixed ? "mixed" : "all"},
                    {"form", row.form},
                    {"bytes", row.bytes},
                    {"of_luanti", row.of_luanti},
                    {"of_luanti_geometric", row.of_luanti_mean},
                    {"of_minecraft", row.of_minecraft},
                    {"encode_us", row.encode_us},
                    {"decode_us", row.decode_us}});
  }
  const nlohmann::ordered_json document = {
      {"cpu", bench.machine.cpu},           {"cores", bench.machine.cores},
      {"compiler", bench.machine.compiler}, {"commit", bench.machine.commit},
      {"repetitions", bench.repetitions},   {"rows", rows},
      {"bars", json_of(bench.targets)}};
  out << document.dump(1) << '\n';
}

}  // namespace runstone::bench
