#include "client/app/player_files.hpp"

#include <chrono>
#include <utility>

#include "common/core/hex.hpp"
#include "common/core/without_exceptions.hpp"

namespace runstone {

PlayerFiles::PlayerFiles(std::string kits_file, std::string hotbars_file)
    : kits_file_(std::move(kits_file)), hotbars_file_(std::move(hotbars_file)) {}

void PlayerFiles::keep(const WorldId& world, const WorldKit& kit, TimeUs now_us) {
  if (kits_file_.empty()) return;
  if (waiting_.empty()) due_us_ = now_us + kDelayUs;
  last_kit_ = {to_hex(world), to_text(kit)};
  waiting_.kits.add(last_kit_->first, last_kit_->second);
}

void PlayerFiles::keep(HotbarRows hotbars, TimeUs now_us) {
  if (hotbars_file_.empty()) return;
  if (waiting_.empty()) due_us_ = now_us + kDelayUs;
  waiting_.hotbars = std::move(hotbars);
}

std::optional<WorldKit> PlayerFiles::kit_of(const WorldId& world) const {
  const std::string id = to_hex(world);
  auto line = waiting_.kits.find(id);
  if (!line) line = written_.kits.find(id);
  if (!line) line = load_kit(kits_file_, id);
  return line ? parse_kit(*line) : std::nullopt;
}

std::string PlayerFiles::step(TimeUs now_us) {
  std::string warning;
  if (write_.valid()) {
    if (write_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return warning;
    if (const auto done = take_written(); !done) {
      warning = done.error();
      due_us_ = now_us + kRetryUs;
    }
  }
  if (waiting_.empty() || now_us < due_us_) return warning;
  written_ = std::exchange(waiting_, {});
  write_ = std::async(std::launch::async, [what = written_, kits = kits_file_,
                                           hotbars = hotbars_file_]() mutable {
    return without_exceptions<void>(kits, [&] { return write(std::move(what), kits, hotbars); });
  });
  return warning;
}

Result<void, std::string> PlayerFiles::finish() {
  if (write_.valid()) static_cast<void>(take_written());  // what failed is tried once more
  if (last_kit_) waiting_.kits.add(last_kit_->first, last_kit_->second);
  if (waiting_.empty()) return {};
  return write(std::exchange(waiting_, {}), kits_file_, hotbars_file_);
}

Result<void, std::string> PlayerFiles::write(Unwritten what, const std::string& kits_file,
                                             const std::string& hotbars_file) {
  auto saved = what.kits.empty() ? Result<void, std::string>{} : what.kits.save(kits_file);
  if (!what.hotbars) return saved;
  const auto saved_hotbars = save_hotbars(hotbars_file, *what.hotbars);
  return saved ? saved_hotbars : saved;
}

void PlayerFiles::wait() const {
  if (write_.valid()) write_.wait();
}

Result<void, std::string> PlayerFiles::take_written() {
  const auto done = write_.get();
  Unwritten tried = std::exchange(written_, {});
  if (done) return done;
  tried.kits.add_all(std::move(waiting_.kits));
  waiting_.kits = std::move(tried.kits);
  if (!waiting_.hotbars) waiting_.hotbars = std::move(tried.hotbars);
  return done;
}

}  // namespace runstone
