// CommandCall: one command under way, with its caller, what commands work on, and the way to
// answer. Thread: the world strand. Reads from the disk run on the workers.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "common/rights/change_rules.hpp"
#include "common/rights/rights_state.hpp"
#include "protocol/codec/messages.hpp"
#include "server/admin/announcements.hpp"
#include "server/admin/command_row.hpp"
#include "server/admin/known_players.hpp"
#include "server/admin/operator_actions.hpp"
#include "server/admin/player_reports.hpp"
#include "server/place/place_service.hpp"
#include "server/rollback/rollback_service.hpp"
#include "server/world/world_server.hpp"

namespace runstone {

class FolderImport;

/// Who gives a command.
struct CommandCaller {
  AuthorId author = 0;  // 0: console or control
  RightsActor actor;    // without a key: console or control
  /// The view of a client that shows what a rollback would change, otherwise nullopt.
  std::optional<View> preview_view = std::nullopt;
  /// No command that needs other rights may be given: the scope of an access token.
  RightSet scope = RightSet::all();
};

/// Returns true if the caller has the right now. Console and operators have every right.
bool has_right(const CommandCaller& caller, const RightsState& state, Right right, TimeUs now_us);

/// Returns why the caller may not give a command with this rule, as a sentence, or nullopt. The
/// sentence names the right that is missing and the caller's role, or the restriction.
std::optional<std::string> why_not(const CommandCaller& caller, const RightsState& state,
                                   const CommandRule& rule, TimeUs now_us);

/// The services on which commands work. The references must outlive the object.
struct CommandServices {
  WorldServer& world;
  RollbackService& rollback;
  RollbackService::Workers& workers;
  PlaceService& placing;
  const std::string world_folder;  // for the pictures of previews
  const OperatorActions actions;
  /// Returns true if the server's settings name the key as an operator's.
  const std::function<bool(const PublicKey&)> is_operator;

  /// A command that goes on when the log is on disk up to a record, and the names up to a change.
  struct Waiting {
    Sequence needed = 0;
    std::function<void()> begin;
    /// Is called instead of `begin` if the log cannot be written any more and, for work, if the
    /// server orders no edits.
    std::function<void()> refuse;
    /// Is called once if the disk is full or this time of the steady clock has passed. May be
    /// empty.
    std::function<void()> report = {};
    TimeUs report_us = 0;
    bool is_work = true;  // otherwise an answer to what is done
    std::uint64_t needed_name_change = 0;
  };
  std::vector<Waiting> waiting = {};
  std::shared_ptr<FolderImport> folder_import = nullptr;  // the last one
  PlayerReports reports = {};
  Announcements announcements = {};

  /// Continues the commands that wait for the disk, and the import of a folder. Writes due
  /// announcements if a player is connected. Call it on every tick, and when the log became durable
  /// or failed.
  void tick(const Clocks& now);
};

/// The time after which a command whose record is not on disk is answered that it is in force.
inline constexpr TimeUs kAnswerUnsavedUs = 1'000'000;

struct CommandCall {
  CommandServices& services;  // must outlive the call
  CommandCaller caller;
  Clocks now;
  CommandReply reply;
  std::string line = {};      // as it was typed
  bool is_confirmed = false;  // kAnyway was typed

  WorldServer& world() const { return services.world; }
  const RightsState& rights() const { return world().rights().state(); }
  TimeUs rights_time() const { return world().rights().time(); }

  /// Sends the last answer to a command that succeeded.
  void answer(std::string text) const { reply(CommandAnswer::last(std::move(text))); }
  /// Sends an answer that others follow.
  void report(std::string text) const { reply(CommandAnswer::progress(std::move(text))); }
  /// Sends the only answer to a command that cannot be carried out.
  void refuse(std::string text) const { runstone::refuse(reply, std::move(text)); }

  /// Calls `work`, which returns a Result, on a worker, and then `go_on` with the value on the
  /// world strand. Refuses the command if no reader can be opened or `work` fails; the text begins
  /// with `name`.
  template <class Work, class GoOn>
  void on_worker(const std::string& name, Work work, GoOn go_on) const;

  using Keys = std::vector<PublicKey>;  // one for each word that was looked up
  /// The players that a worker has found for the words of a command.
  struct FoundPlayers {
    std::shared_ptr<const KnownPlayers> known;  // never null
    Keys keys;
    /// For each pattern of names the author numbers of the players whom it selects.
    std::vector<std::set<AuthorId>> matches;
  };
  /// Looks up players on a worker. Calls `go_on` with what is known, with the key of each word, and
  /// with the authors of each pattern (is_name_pattern). Refuses the command if a word means nobody
  /// or several players, with a text that begins with `before`.
  void find_players(const std::vector<std::string>& words, const std::vector<std::string>& patterns,
                    std::function<void(const FoundPlayers&)> go_on,
                    const std::string& before = "") const;
  /// Does what find_players() does, without patterns.
  void with_players(const std::vector<std::string>& words,
                    std::function<void(const KnownPlayers&, const Keys&)> go_on,
                    const std::string& before = "") const;
  /// Refuses the command with a hazard, which is a sentence without a period, and with the line to
  /// repeat, unless the line ended with kAnyway. Returns true if it refused.
  bool refuse_unless_confirmed(const std::optional<std::string>& hazard) const;
  /// Answers a command whose record is ordered, and in force, when it is on disk. If that takes
  /// kAnswerUnsavedUs, or the disk is full, an answer that is_unsaved comes before.
  void answer_when_durable(Sequence record, const std::string& text) const;
  /// Answers a command that has changed names as answer_when_durable() answers one with a record.
  void answer_when_names_durable(const std::string& text) const;
  /// Orders a change of rights, if the caller may make it. Answers when it is on disk with "text
  /// (record N)" and the number of sessions that it ended, or with why it was refused. A change of
  /// which hazard_of() warns must be confirmed. `in_force` is called when the change is in force,
  /// and returns the text that is appended to the answer. If it is null, no text is appended.
  void change_rights(const RightsChange& change, const std::string& text,
                     const std::function<std::string()>& in_force = nullptr) const;

 private:
  void answer_when_durable(Sequence record, std::uint64_t name_change,
                           const std::string& text) const;
};

inline std::string error_text(const StoreError& error) { return error.message(); }
inline std::string error_text(const std::string& error) { return error; }

template <class Work, class GoOn>
void CommandCall::on_worker(const std::string& name, Work work, GoOn go_on) const {
  auto found = std::make_shared<std::optional<std::invoke_result_t<Work, WorldReader&>>>();
  services.workers.run(
      [found, work](WorldReader& reader, const Generator&) { found->emplace(work(reader)); },
      [found, call = *this, name, go_on](const std::string& error) {
        if (!error.empty()) return call.refuse(name + error);
        if (!**found) return call.refuse(name + error_text((*found)->error()));
        go_on(***found);
      });
}

}  // namespace runstone
