#include "server/admin/allow_commands.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "common/core/text.hpp"
#include "common/names/folded_name.hpp"
#include "server/admin/allow_file.hpp"
#include "server/admin/command_call.hpp"
#include "server/admin/rights_change_text.hpp"

namespace runstone {
namespace {

/// The greatest number of changes of rights between two waits for the disk. The bound lets other
/// work run during a long list.
constexpr std::size_t kAllowedAtOnce = 50;
constexpr TimeUs kInviteOfListUs = TimeUs{30} * 86'400'000'000;

Result<AllowImportCommand, std::string> parse_allow_import(WordReader& reader) {
  AllowImportCommand command;
  command.file = reader.take("allow import", "a file");
  while (!reader.at_end()) {
    if (reader.take_word("role")) {
      command.role = reader.rights_name("allow import role");
    } else if (reader.take_word("invites")) {
      command.makes_invites = true;
    } else {
      reader.wrong("allow import \"" + reader.peek() + "\": role ROLE or invites");
    }
  }
  return reader.result(command);
}

/// A list of players that is imported.
class AllowImport : public std::enable_shared_from_this<AllowImport> {
 public:
  AllowImport(const CommandCall& call, AllowImportCommand command, AllowList list)
      : call_(call), command_(std::move(command)), list_(std::move(list)) {}

  /// Takes the next entries, and then waits until they are on disk.
  void step() {
    std::size_t changes = 0;
    for (; next_ < list_.entries.size() && changes < kAllowedAtOnce; ++next_) {
      const Sequence before = newest_;
      take(list_.entries[next_]);
      if (newest_ != before) ++changes;
    }
    call_.services.waiting.push_back({newest_, [self = shared_from_this()] { self->go_on(); },
                                      [self = shared_from_this()] { self->give_up(); }});
  }

 private:
  void go_on() {
    if (next_ < list_.entries.size()) return step();
    call_.answer(summary() + lines_);
  }
  void give_up() {
    call_.refuse(summary() + "; the log takes no edits any more, so the rest was left out" +
                 lines_);
  }
  std::string summary() const {
    return command_.file + ": " + std::to_string(added_) + " added, " + std::to_string(invited_) +
           " invited, " + std::to_string(known_) + " already there, " + std::to_string(refused_) +
           " refused";
  }
  void note(const AllowEntry& entry, std::size_t& count, const std::string& what) {
    ++count;
    lines_ += "\n" + std::string(list_.unit) + " " + std::to_string(entry.number) + " " +
              with_unseen_replaced(entry.name) + ": " + what;
  }

  void take(const AllowEntry& entry) {
    if (!entry.fault.empty()) return note(entry, refused_, "refused: it " + entry.fault);
    if (!is_plain_name(entry.name) || entry.name.size() > kPlayerNameBytesMax)
      return note(entry, refused_, "refused: no player can have this name");
    if (const auto fault = name_fault(entry.name))
      return note(entry, refused_, "refused: the name " + *fault);
    const NameClaim* owner = call_.world().order().names().find(folded_name(entry.name));
    if (owner == nullptr) return take_unknown(entry);
    const PublicKey& key = owner->key;
    const auto grant = call_.rights().grants().find(key);
    if (grant != call_.rights().grants().end())
      return note(entry, known_, "already there: the player has the role " + grant->second.value);
    if (const auto* timed = call_.rights().timed_grant(key, call_.rights_time()))
      return note(entry, refused_,
                  "refused: the player has the role " + timed->value.role +
                      " for some time, which this would end (grant does it)");
    if (call_.rights().restriction(RestrictionKind::ban, key, call_.rights_time()) != nullptr)
      return note(entry, refused_, "refused: the player is banned (unban lifts it)");
    const auto seq = change(GrantRole{key, command_.role});
    if (!seq) return note(entry, refused_, "refused: " + seq.error());
    note(entry, added_, "added (record " + std::to_string(*seq) + ")");
  }

  void take_unknown(const AllowEntry& entry) {
    const std::string folded = folded_name(entry.name);
    if (std::ranges::find(invited_names_, folded) != invited_names_.end())
      return note(entry, known_, "already there: the list names the player before");
    if (!command_.makes_invites)
      return note(
          entry, refused_,
          "refused: nobody owns this name yet (the word invites makes a link for the player)");
    const Invite invite{call_.world().people().new_invite_id(), command_.role, 1,
                        call_.rights_time() + kInviteOfListUs};
    const auto seq = change(CreateInvite{invite});
    if (!seq) return note(entry, refused_, "refused: " + seq.error());
    invited_names_.push_back(folded);
    note(entry, invited_, "invited: " + call_.world().people().invite_link(invite.id));
  }

  Result<Sequence, std::string> change(const RightsChange& change) {
    auto seq = call_.world().changes().change_rights(change, call_.caller.actor,
                                                     call_.caller.author, call_.now);
    if (seq) newest_ = *seq;
    return seq;
  }

  const CommandCall call_;
  const AllowImportCommand command_;
  const AllowList list_;
  std::size_t next_ = 0;
  std::size_t added_ = 0, invited_ = 0, known_ = 0, refused_ = 0;
  std::vector<std::string> invited_names_;  // folded
  std::string lines_;
  Sequence newest_ = 0;
};

void import_allow_list(const CommandCall& call, const AllowImportCommand& command) {
  const Decided<Role>* role = call.rights().find_role(command.role);
  if (role == nullptr)
    return call.refuse("allow import: there is no role \"" + command.role +
                       "\" (roles lists them)");
  const RightSet powers = role->value.rights.and_in(kRightsOverOthers);
  if (powers != RightSet() &&
      call.refuse_unless_confirmed("all players of the list would have the rights " +
                                   rights_text(powers)))
    return;
  call.on_worker(
      "allow import: ", [file = command.file](WorldReader&) { return read_allow_file(file); },
      [call, command](const AllowList& list) {
        std::make_shared<AllowImport>(call, command, list)->step();
      });
}

constexpr std::array<CommandRow, 1> kAllowRows = {{
    {.words = "allow import FILE",
     .rule = kLocal,
     .help =
         "allow import FILE [role ROLE] [invites]\n"
         "                          give the players of a list a role: names, one a line, CSV, "
         "or JSON\n"
         "                          with `name`; invites: make a link for names that nobody owns",
     .functions = parsed_by<parse_allow_import, import_allow_list>(),
     .may_be_confirmed = true},
}};

}  // namespace

std::span<const CommandRow> allow_commands() { return kAllowRows; }

}  // namespace runstone
