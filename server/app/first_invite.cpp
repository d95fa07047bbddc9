#include "server/app/first_invite.hpp"

#include <sys/stat.h>

#include <cstdlib>

namespace runstone {

std::string make_first_invite(Server& server) {
  const CommandAnswer answer = server.answer_of("invite role administrator uses 1 for 24h");
  if (!answer.is_ok) return "there is no invite for an administrator: " + answer.text;
  const std::string link = answer.text.substr(0, answer.text.find('\n'));
  return "This world has no administrator. The first who joins with this link, within 24 hours, is "
         "one:\n  runstone-client --connect '" +
         link + "' --name NAME --key FILE";
}

bool is_journal(int descriptor) {
  // systemd.exec(5): device and inode of the stream that systemd connected to the journal.
  const char* const stream = std::getenv("JOURNAL_STREAM");
  struct stat about{};
  if (stream == nullptr || ::fstat(descriptor, &about) != 0) return false;
  return stream == std::to_string(about.st_dev) + ":" + std::to_string(about.st_ino);
}

}  // namespace runstone
