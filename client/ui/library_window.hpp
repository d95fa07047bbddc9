// LibraryWindow: the library of builds of the world. The user searches it, takes a build into the
// clipboard, and adds the clipboard as a build. One thread.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "client/render/overlay_frame.hpp"
#include "client/ui/ui_context.hpp"
#include "common/core/ids.hpp"
#include "protocol/codec/build_messages.hpp"

namespace runstone {

/// The content of the window. All texts may be shown as they are.
struct LibraryState {
  std::string unavailable;  // why there is no library; empty: there is one
  // The listing. Null: none has arrived. Otherwise it must outlive the call.
  const std::vector<ListedBuild>* builds = nullptr;
  bool has_more = false, is_listing = false;
  std::uint64_t total = 0;   // builds in the library
  std::string list_refusal;  // why the last listing failed
  AuthorId me = 0;
  bool removes_all = false;  // the player may remove the builds of others, too

  Sequence fetching = 0;  // the build whose file is fetched or read; 0: none
  std::uint64_t fetched_bytes = 0, fetch_bytes = 0;
  bool is_taking = false;  // it goes to the clipboard
  Sequence pictured = 0;   // the build of `picture`
  std::shared_ptr<const OverlayImage> picture;
  std::string fetch_text;   // the end of the last fetch
  std::uint64_t taken = 0;  // how many builds went to the clipboard

  std::string clipboard;  // its size in words; empty: nothing was copied
  bool is_adding = false;
  std::uint64_t added_bytes = 0, add_bytes = 0;
  std::string add_text;     // the end of the last addition
  std::string remove_text;  // the answer to the last removal
  bool is_removing = false;
};

/// An order of the user.
struct FindBuilds {
  std::string name, author, tag;  // all must fit; empty: any
};
struct FindMoreBuilds {};
/// Shows the picture of a build.
struct ShowBuild {
  Sequence number = 0;
};
/// Puts a build into the clipboard.
struct TakeBuild {
  Sequence number = 0;
};
/// Removes a build from the library.
struct DropBuild {
  Sequence number = 0;
};
/// Ends the fetch.
struct StopFetch {};
/// Adds the clipboard as a build. `tags` have commas between them.
struct AddClipboard {
  std::string name, tags;
};
/// Ends the addition.
struct StopAdding {};
using LibraryOrder = std::variant<FindBuilds, FindMoreBuilds, ShowBuild, TakeBuild, DropBuild,
                                  StopFetch, AddClipboard, StopAdding>;

class LibraryWindow {
 public:
  /// A build whose file is no larger is fetched for its picture when it is selected.
  static constexpr std::uint64_t kShownBytesMax = std::uint64_t{1} << 20;

  void toggle() { set_open(!is_open_); }
  void set_open(bool is_open);
  bool close() { return std::exchange(is_open_, false); }
  bool is_open() const { return is_open_; }
  /// Returns the selected build, or 0.
  Sequence selected() const { return selected_; }
  /// Makes the window with ImGui. Returns what the user ordered. When a build has been copied to the
  /// clipboard, the window closes, so that the next click pastes it.
  std::optional<LibraryOrder> build(const LibraryState& state, UiContext& context);

 private:
  void build_search(const LibraryState& state, double scale);
  void build_list(const LibraryState& state, double scale);
  void build_selected(const LibraryState& state, UiContext& context);
  void build_buttons(const LibraryState& state, const ListedBuild& build);
  void build_adding(const LibraryState& state, double scale);

  bool is_open_ = false;
  std::uint64_t taken_ = 0;  // as LibraryState::taken in the last frame
  bool is_new_ = false;      // the window was opened since the last frame
  std::string name_, author_, tag_;
  Sequence selected_ = 0;
  Sequence drop_ = 0;  // the build for which the user was asked whether it is to be removed
  std::string add_name_, add_tags_;
  std::optional<LibraryOrder> order_;  // of this frame
};

}  // namespace runstone
