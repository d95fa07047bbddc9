// LibraryControl: what the player does with the library of builds of the world. It is between the
// window (or a script), the session, and the clipboard of the tools. Files are read and written on a
// thread of their own, or in step() if the client has no threads. The destructor waits for that thread.
// Thread: the main thread.
#pragma once
#include <cstdint>
#include <future>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "client/panels/library_file.hpp"
#include "client/session/client_session.hpp"
#include "client/tools/tool_box.hpp"
#include "client/ui/library_window.hpp"

namespace runstone {

class LibraryControl {
 public:
  /// Session and tools must outlive the object. `has_threads`: files are read and written on threads.
  LibraryControl(ClientSession& session, ToolBox& tools, bool has_threads)
      : session_(session),
        tools_(tools),
        launch_(has_threads ? std::launch::async : std::launch::deferred) {}

  /// Carries out what the user ordered in the window.
  void carry_out(const LibraryOrder& order);

  /// Lists the newest builds if nothing was listed yet. Call it every turn while the window is open.
  void list_first();

  /// Forgets the build whose picture is shown, because the window is closed. Its memory may be that of a
  /// town.
  void drop_picture() { held_.reset(); }

  /// Begin one of these for a script. Poll is_busy(); then has_succeeded() and answer() hold the
  /// result. `name` is a part of the names of the listed builds.
  void list(const std::string& name);
  void take(Sequence number);
  void add(const std::string& name);
  /// Returns true until the last list(), take() or add() has ended.
  bool is_busy() const { return asked_ != Asked::nothing; }
  bool has_succeeded() const { return has_succeeded_; }
  /// Returns the lines for the user of a script.
  const std::vector<std::string>& answer() const { return answer_; }
  /// Returns true while the window has no listing, or while a build is fetched, read or written.
  bool is_loading() const;

  /// Sends requests, and takes answers and files. Returns true if what the window shows has changed.
  /// Call it every turn. Cost: O(1), or O(runs of the build) in the turn in which a build goes to the
  /// clipboard.
  bool step(TimeUs now_us);
  void fill(LibraryState& state) const;
  /// Returns lines for the player since the last call.
  std::vector<std::string> take_notices() { return std::exchange(notices_, {}); }

 private:
  enum class Asked : std::uint8_t { nothing, list, take, add };
  /// Where the build goes that is fetched.
  enum class Goal : std::uint8_t { none, picture, clipboard };

  void fetch(Sequence number, Goal goal);
  void stop_fetch();
  void stop_adding();
  void begin_adding(const std::string& name, const std::string& tags);
  void drop_build(Sequence number);
  bool step_fetch();
  bool step_adding();
  bool step_removal();
  void reach_goal();
  void end_fetch(std::string text, bool is_ok);
  void end_adding(std::string text, bool is_ok);
  void list_again();
  void step_listing();
  /// Ends what a script asked for.
  void finish(Asked asked, bool is_ok, std::vector<std::string> lines);
  void forget();

  struct Held {
    Sequence number = 0;
    LibraryBuild build;
  };

  ClientSession& session_;
  ToolBox& tools_;
  const std::launch launch_;
  std::optional<WorldId> world_;  // whose library it is

  Goal goal_ = Goal::none;
  Sequence wanted_ = 0;       // the build of goal_
  std::optional<Held> held_;  // the build that was read last
  Sequence reading_ = 0;      // the build of read_
  std::future<Result<LibraryBuild, std::string>> read_;
  std::string fetch_text_;
  std::uint64_t taken_ = 0;  // builds that went to the clipboard

  bool is_adding_ = false;         // until the answer is complete, the writing of the file included
  bool is_adding_wanted_ = false;  // the file of written_ is to be sent
  std::future<Result<Bytes, std::string>> written_;
  std::string add_name_, add_text_;

  bool is_removing_ = false;
  Sequence removed_ = 0;
  std::string remove_text_;

  Asked asked_ = Asked::nothing;
  bool has_succeeded_ = false;
  std::vector<std::string> answer_, notices_;
  std::uint64_t serial_ = 0;  // of the exchange that was shown last
  bool was_open_ = false;     // the world had a library in the last turn
};

}  // namespace runstone
