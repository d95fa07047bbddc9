#include "client/app/clipboard_transfer.hpp"

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <utility>

#include "client/app/clipboard_file.hpp"
#include "client/tools/build_words.hpp"
#include "common/build_files/build_files.hpp"
#include "common/core/without_exceptions.hpp"

namespace runstone {
namespace {

template <class Outcome>
bool has_outcome(const std::future<Outcome>& work) {
  return work.valid() && work.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

PlayerNotice transfer_warning(std::string text) { return {std::move(text), NoticeKind::warning}; }

std::string last_part(const std::string& file) {
  return std::filesystem::path(file).filename().string();
}

}  // namespace

std::string typed_path(const std::string& typed) {
  const auto is_around = [](char c) { return c == ' ' || c == '\t' || c == '"' || c == '\''; };
  std::size_t first = 0, last = typed.size();
  while (first < last && is_around(typed[first])) ++first;
  while (last > first && is_around(typed[last - 1])) --last;
  std::string path = typed.substr(first, last - first);
  const char* const home = std::getenv("HOME");
  if (path.starts_with("~/") && home != nullptr) path.replace(0, 1, home);
  return path;
}

std::optional<PlayerNotice> ClipboardTransfer::begin(const ClipboardOfFile& order,
                                                     const ToolBox& tools) {
  if (!state_.empty()) return transfer_warning("wait: " + state_);
  file_ = typed_path(order.file);
  if (file_.empty()) return transfer_warning("type the path of a file, such as ~/castle.schem");
  if (auto why = file_refusal(file_, order.is_saved); !why.empty()) return transfer_warning(why);
  if (order.is_saved) {
    auto build = build_of_clipboard(file_, tools);
    if (!build) return transfer_warning(build.error());
    state_ = "writing " + last_part(file_);
    writing_ = std::async(std::launch::async, [file = file_, build = *std::move(build)] {
      return without_exceptions<std::uint64_t>(file,
                                               [&] { return write_build_to_file(file, build); });
    });
  } else {
    state_ = "reading " + last_part(file_);
    shared_ = std::make_shared<Reading>();
    reading_ = std::async(std::launch::async, [file = file_, order, shared = shared_] {
      BuildReading reading;
      static_cast<ModelChoices&>(reading.model) = order.model;
      reading.model.file.should_continue = [shared] { return shared->is_wanted.load(); };
      reading.model.progress = [shared](double share) { shared->share.store(share); };
      reading.notice = [&](const std::string& line) { shared->notices += ". " + line; };
      return without_exceptions<FileBuild>(
          file, [&] { return read_build_of_file(file, std::move(reading)); });
    });
  }
  return std::nullopt;
}

std::optional<PlayerNotice> ClipboardTransfer::step(ToolBox& tools) {
  if (has_outcome(writing_)) {
    state_.clear();
    const auto written = writing_.get();
    if (!written) return transfer_warning("not written: " + written.error());
    return PlayerNotice{"written: " + file_};
  }
  if (!has_outcome(reading_)) return std::nullopt;
  state_.clear();
  auto read = reading_.get();
  if (!shared_->is_wanted) return PlayerNotice{"stopped: " + file_ + " was not read"};
  if (!read) return transfer_warning(read.error());
  const std::string said = set_clipboard(*std::move(read), tools);
  if (!tools.clipboard().build) return transfer_warning(said);
  has_loaded_ = true;
  std::string text = "clipboard: " + last_part(file_) + ", " + size_text(*tools.clipboard().build);
  text += shared_->notices;
  if (!said.empty()) text += ". " + said;
  return PlayerNotice{std::move(text)};
}

void ClipboardTransfer::stop() {
  if (shared_ == nullptr || !reading_.valid()) return;
  shared_->is_wanted = false;
  state_ = "stopping: " + last_part(file_);
}

FileState ClipboardTransfer::state() const {
  FileState out{state_, std::nullopt, false};
  if (!reading_.valid() || !shared_->is_wanted) return out;
  out.can_stop = true;
  if (const double share = shared_->share; share >= 0) {
    out.text = "making voxels of " + last_part(file_);
    out.share = share;
  }
  return out;
}

}  // namespace runstone
