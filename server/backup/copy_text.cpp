#include "server/backup/copy_text.hpp"

#include <iomanip>
#include <ostream>
#include <sstream>

#include "common/core/hex.hpp"

namespace runstone {

std::string seconds_text(double seconds) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(1) << seconds << " s";
  return text.str();
}

void print_copy(const WorldBackup& backup, std::ostream& out) {
  out << "world       " << to_hex(backup.world) << '\n'
      << "moment      epoch=" << backup.moment.epoch << " seq=" << backup.moment.seq << '\n'
      << "copied      " << backup.moment.bytes << " bytes in " << seconds_text(backup.copy_s)
      << '\n'
      << "verified    the database, every row, and " << backup.edits
      << " edits up to seq=" << backup.moment.seq << ", in " << seconds_text(backup.check_s)
      << '\n';
  if (backup.left_out.empty()) return;
  out << "left out   ";
  for (const std::string& name : backup.left_out) out << ' ' << name;
  out << '\n';
}

}  // namespace runstone
