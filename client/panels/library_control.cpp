#include "client/panels/library_control.hpp"

#include <chrono>

#include "client/tools/build_words.hpp"
#include "common/core/text.hpp"
#include "common/core/without_exceptions.hpp"
#include "common/rights/right.hpp"

namespace runstone {
namespace {

/// Returns true if the result can be taken. A file that no thread reads or writes is made by get().
template <class T>
bool is_ready(const std::future<T>& result) {
  return result.valid() && result.wait_for(std::chrono::seconds(0)) != std::future_status::timeout;
}

std::string listed_line(const ListedBuild& build) {
  const BuildSides& sides = build.info.sides;
  std::string out = std::to_string(build.number) + "  " + build.info.name + "  " +
                    std::to_string(sides.x) + " x " + std::to_string(sides.y) + " x " +
                    std::to_string(sides.z) + "  " + std::to_string(build.file_bytes) + " bytes";
  if (!build.info.author.empty()) out += "  by " + build.info.author;
  for (const std::string& tag : build.info.tags) out += "  [" + tag + "]";
  return out;
}

}  // namespace

// Orders.

void LibraryControl::carry_out(const LibraryOrder& order) {
  if (const auto* search = std::get_if<FindBuilds>(&order))
    session_.library().list({search->name, search->author, search->tag});
  if (std::holds_alternative<FindMoreBuilds>(order)) session_.library().list_more();
  if (const auto* shown = std::get_if<ShowBuild>(&order)) {
    // A picture does not replace the build that the player takes.
    if (goal_ != Goal::clipboard) fetch(shown->number, Goal::picture);
  }
  if (const auto* taken = std::get_if<TakeBuild>(&order)) fetch(taken->number, Goal::clipboard);
  if (const auto* dropped = std::get_if<DropBuild>(&order)) drop_build(dropped->number);
  if (std::holds_alternative<StopFetch>(order)) stop_fetch();
  if (const auto* added = std::get_if<AddClipboard>(&order)) begin_adding(added->name, added->tags);
  if (std::holds_alternative<StopAdding>(order)) stop_adding();
}

void LibraryControl::list(const std::string& name) {
  asked_ = Asked::list;
  session_.library().list({name, {}, {}});
}

void LibraryControl::take(Sequence number) {
  asked_ = Asked::take;
  fetch(number, Goal::clipboard);
}

void LibraryControl::add(const std::string& name) {
  asked_ = Asked::add;
  begin_adding(name, {});
}

void LibraryControl::finish(Asked asked, bool is_ok, std::vector<std::string> lines) {
  if (asked_ != asked) return;
  asked_ = Asked::nothing;
  has_succeeded_ = is_ok;
  answer_ = std::move(lines);
}

void LibraryControl::list_again() {
  const LibraryExchange::Listing& listing = session_.library().listing();
  if (listing.is_known) session_.library().list(listing.search);
}

// Fetching.

void LibraryControl::fetch(Sequence number, Goal goal) {
  fetch_text_.clear();
  const bool is_under_way = goal_ != Goal::none && wanted_ == number;
  goal_ = goal;
  wanted_ = number;
  if (is_under_way) return;
  if (reading_ == number && read_.valid()) {
    session_.library().stop_fetch();
    return;
  }
  if (held_ && held_->number == number) {
    session_.library().stop_fetch();
    return reach_goal();
  }
  session_.library().fetch(number);
}

void LibraryControl::stop_fetch() {
  session_.library().stop_fetch();
  end_fetch("stopped", false);
}

void LibraryControl::end_fetch(std::string text, bool is_ok) {
  const Goal goal = std::exchange(goal_, Goal::none);
  fetch_text_ = std::move(text);
  if (goal != Goal::clipboard) return;
  if (!fetch_text_.empty()) notices_.push_back(fetch_text_);
  finish(Asked::take, is_ok, {fetch_text_});
}

void LibraryControl::reach_goal() {
  const LibraryBuild& held = held_->build;
  if (goal_ == Goal::picture) return end_fetch({}, true);
  if (goal_ != Goal::clipboard) return;
  const std::string lost =
      with_unseen_replaced(tools_.set_clipboard(held.build, EmptyCells::pasted, held.rows));
  if (!tools_.clipboard().build) return end_fetch(lost, false);
  static_cast<void>(tools_.choose("paste"));
  ++taken_;
  std::string text = "\"" + held.info.name + "\" is in the clipboard: click to paste it";
  if (!lost.empty()) text += "; " + lost;
  end_fetch(std::move(text), true);
}

bool LibraryControl::step_fetch() {
  bool has_changed = false;
  if (is_ready(read_)) {
    has_changed = true;
    const Sequence number = std::exchange(reading_, 0);
    auto read = read_.get();
    const bool is_wanted = goal_ != Goal::none && wanted_ == number;
    if (number == 0) {
      // It is of another world.
    } else if (read) {
      held_ = Held{number, *std::move(read)};
      if (is_wanted) reach_goal();
    } else if (is_wanted) {
      end_fetch(with_unseen_replaced(read.error()), false);
    }
  }
  LibraryExchange& library = session_.library();
  const LibraryExchange::Fetch& fetched = library.fetched();
  if (goal_ == Goal::none) return has_changed;
  if (fetched.state == TransferState::none && !read_.valid()) {
    end_fetch("the connection ended", false);  // and the next world is another one
    return true;
  }
  if (fetched.state == TransferState::failed) {
    const std::string why = fetched.refusal;
    library.stop_fetch();
    end_fetch(why, false);
    return true;
  }
  if (fetched.state != TransferState::done || read_.valid()) return has_changed;
  reading_ = fetched.number;
  read_ = std::async(launch_, [file = library.take_file()] {
    return without_exceptions<LibraryBuild>("the build", [&] { return read_library_file(file); });
  });
  return true;
}

// Adding.

void LibraryControl::begin_adding(const std::string& name, const std::string& tags) {
  if (is_adding_ || written_.valid()) {
    add_text_ = "another build is being added: wait for its end";
    return finish(Asked::add, false, {add_text_});
  }
  const auto refuse = [this](std::string why) {
    add_text_ = std::move(why);
    finish(Asked::add, false, {add_text_});
  };
  const ToolClipboard& clipboard = tools_.clipboard();
  if (!clipboard.build) return refuse("the clipboard is empty: copy a selection first");
  auto info = named_build(name, tags, session_.name());
  if (!info) return refuse("the build is not added: " + info.error());
  add_name_ = info->name;
  add_text_.clear();
  is_adding_ = is_adding_wanted_ = true;
  const auto rows = tools_.clipboard_rows();
  written_ = std::async(launch_, [build = clipboard.build, empty = clipboard.empty,
                                  rows = std::vector<MaterialRow>(rows.begin(), rows.end()),
                                  info = *std::move(info)] {
    return without_exceptions<Bytes>("the build", [&] {
      return write_library_file(*build, rows, info, empty, LibraryExchange::kFileBytesMax);
    });
  });
}

void LibraryControl::stop_adding() {
  if (!is_adding_) return;
  const bool is_sent = session_.library().has_sent_all();
  session_.library().stop_adding();
  end_adding(is_sent ? "stopped, but the server has the whole file and may add it: see the list"
                     : "stopped: nothing is added",
             false);
}

void LibraryControl::end_adding(std::string text, bool is_ok) {
  is_adding_ = is_adding_wanted_ = false;
  add_text_ = std::move(text);
  notices_.push_back(add_text_);
  finish(Asked::add, is_ok, {add_text_});
}

bool LibraryControl::step_adding() {
  bool has_changed = false;
  LibraryExchange& library = session_.library();
  if (is_ready(written_)) {
    has_changed = true;
    auto written = written_.get();
    if (std::exchange(is_adding_wanted_, false)) {
      if (written) {
        library.add(*std::move(written));
      } else {
        end_adding("the build is not added: " + written.error(), false);
      }
    }
  }
  if (!is_adding_ || is_adding_wanted_) return has_changed;
  const LibraryExchange::Addition addition = library.addition();
  if (addition.state == TransferState::none) {
    end_adding("the connection ended: see the list before you add the build again", false);
    return true;
  }
  if (addition.state == TransferState::failed) {
    library.stop_adding();
    end_adding("the build is not added: " + addition.refusal, false);
    return true;
  }
  if (addition.state != TransferState::done) return has_changed;
  library.stop_adding();
  end_adding("\"" + add_name_ + "\" is in the library: build " + std::to_string(addition.number),
             true);
  list_again();
  return true;
}

// Removing.

void LibraryControl::drop_build(Sequence number) {
  if (is_removing_) return;
  if (const auto given = session_.command("builds remove " + std::to_string(number)); !given) {
    remove_text_ = given.error().what;
    return;
  }
  is_removing_ = true;
  removed_ = number;
  remove_text_.clear();
}

bool LibraryControl::step_removal() {
  if (!is_removing_ || session_.commanding()) return false;
  is_removing_ = false;
  remove_text_.clear();
  for (const std::string& line : session_.command_lines())
    remove_text_ += (remove_text_.empty() ? "" : "\n") + with_unseen_replaced(line);
  if (!session_.command_ok()) return true;
  if (held_ && held_->number == removed_) held_.reset();
  list_again();
  return true;
}

// Turns.

/// Ends all that was begun in another world.
void LibraryControl::forget() {
  if (is_adding_) {
    session_.library().stop_adding();
    end_adding(
        "this is another world: see the list of the other one before you add the build again",
        false);
  }
  if (goal_ != Goal::none) end_fetch("the connection ended", false);
  reading_ = 0;
  held_.reset();
  fetch_text_.clear();
  add_text_.clear();
  remove_text_.clear();
}

void LibraryControl::step_listing() {
  const LibraryExchange::Listing& listing = session_.library().listing();
  if (asked_ != Asked::list || listing.is_waiting) return;
  if (!listing.refusal.empty()) return finish(Asked::list, false, {listing.refusal});
  if (!listing.is_known) return finish(Asked::list, false, {"the connection ended"});
  std::vector<std::string> lines;
  for (const ListedBuild& build : listing.builds) lines.push_back(listed_line(build));
  lines.push_back("the library has " + std::to_string(listing.total) +
                  (listing.total == 1 ? " build" : " builds") +
                  (listing.has_more ? "; more of them fit" : ""));
  finish(Asked::list, true, std::move(lines));
}

void LibraryControl::list_first() {
  const LibraryExchange::Listing& listing = session_.library().listing();
  if (session_.has_library() && !listing.is_known && !listing.is_waiting && listing.refusal.empty())
    session_.library().list({});
}

bool LibraryControl::step(TimeUs now_us) {
  if (const auto& welcome = session_.welcome(); welcome && world_ != welcome->world_id) {
    if (world_) forget();
    world_ = welcome->world_id;
  }
  bool has_changed = step_removal();
  has_changed = step_fetch() || has_changed;
  has_changed = step_adding() || has_changed;
  session_.step_library(now_us);
  step_listing();
  const bool is_open = session_.has_library();
  has_changed = std::exchange(was_open_, is_open) != is_open || has_changed;
  const std::uint64_t serial = session_.library().serial();
  return std::exchange(serial_, serial) != serial || has_changed;
}

bool LibraryControl::is_loading() const {
  if (!session_.has_library()) return false;
  const LibraryExchange::Listing& listing = session_.library().listing();
  return listing.is_waiting || (!listing.is_known && listing.refusal.empty()) ||
         goal_ != Goal::none || is_adding_ || is_removing_;
}

void LibraryControl::fill(LibraryState& state) const {
  if (!session_.is_open()) {
    state.unavailable = "no world is open";
  } else if (!session_.has_library()) {
    state.unavailable = "This server gives clients no library of builds.";
  }
  const LibraryExchange& library = session_.library();
  const LibraryExchange::Listing& listing = library.listing();
  if (listing.is_known) state.builds = &listing.builds;
  state.has_more = listing.has_more;
  state.is_listing = listing.is_waiting;
  state.total = listing.total;
  state.list_refusal = listing.refusal;
  state.me = session_.author();
  const auto& permissions = session_.replica().ground().permissions();
  state.removes_all = permissions && RightSet::of_bits(permissions->rights).has(Right::administer);
  if (goal_ != Goal::none) {
    state.fetching = wanted_;
    state.fetched_bytes = library.fetched().bytes.size();
    state.fetch_bytes = library.fetched().file_bytes;
    state.is_taking = goal_ == Goal::clipboard;
  }
  if (held_) {
    state.pictured = held_->number;
    state.picture = held_->build.picture;
  }
  state.fetch_text = fetch_text_;
  state.taken = taken_;
  if (tools_.clipboard().build) state.clipboard = size_text(*tools_.clipboard().build);
  state.is_adding = is_adding_;
  state.added_bytes = library.addition().received_bytes;
  state.add_bytes = library.addition().file_bytes;
  state.add_text = add_text_;
  state.remove_text = remove_text_;
  state.is_removing = is_removing_;
}

}  // namespace runstone
