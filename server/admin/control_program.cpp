#include "server/admin/control_program.hpp"

#include <unistd.h>

#include <algorithm>
#include <asio/io_context.hpp>
#include <asio/local/stream_protocol.hpp>
#include <asio/read_until.hpp>
#include <asio/write.hpp>
#include <filesystem>
#include <iostream>
#include <ostream>
#include <system_error>

#include "common/core/text.hpp"
#include "common/os/passphrase.hpp"
#include "common/os/text_file.hpp"
#include "server/admin/command_table.hpp"
#include "server/admin/control_socket.hpp"
#include "server/admin/place_words.hpp"

namespace runstone {

namespace {

bool is_quoted(const std::string& word) {
  return word.size() >= 2 && word.front() == '"' && word.back() == '"';
}

}  // namespace

std::vector<std::string> with_whole_paths(std::vector<std::string> words) {
  const CommandRow* row = find_command(words);
  if (row == nullptr || !row->words.ends_with(" FILE")) return words;
  const auto file = static_cast<std::size_t>(std::count(row->words.begin(), row->words.end(), ' '));
  for (std::size_t i = file; i < words.size(); ++i) {
    const bool is_behind_word = words[i - 1] == kMapWord || words[i - 1] == kColoursWord;
    const bool is_file = i == file || (row->words == kImportFileWords && is_behind_word);
    std::error_code ignored;
    if (is_file && !is_quoted(words[i]))
      words[i] = std::filesystem::absolute(words[i], ignored).string();
  }
  return words;
}

std::string control_line(const std::vector<std::string>& words) {
  if (words.size() == 1) return words.front();
  std::string line;
  for (const std::string& word : words) {
    if (!line.empty()) line += ' ';
    const bool is_plain = !word.empty() && word.find(' ') == std::string::npos;
    line += is_plain || is_quoted(word) ? word : "\"" + word + "\"";
  }
  return line;
}

Result<std::string, std::string> read_new_password() {
  if (::isatty(STDIN_FILENO) == 1) return ask_new_passphrase("password for the world: ");
  std::string line = first_line_of(std::cin);
  if (line.empty()) return failure("password set: standard input is no terminal and has no line");
  return line;
}

Result<std::string, std::string> completed_line(const std::string& line,
                                                const ReadPassword& read_password) {
  const auto command = parse_command(line, 0);
  if (!command || command->row->complete == nullptr) return line;  // the server answers mistakes
  return command->row->complete(line, command->meaning, read_password);
}

Result<ControlEnd, std::string> control_server(const ControlRequest& request, std::ostream& out,
                                               const ReadPassword& read_password) {
  auto completed = completed_line(control_line(with_whole_paths(request.words)), read_password);
  if (!completed) return failure(completed.error());
  std::string line = *std::move(completed);
  if (!is_printable_utf8(line))
    return failure("control: the command is not one line of UTF-8 text");
  line += '\n';
  const auto path = control_path(request.world);
  if (!path) return failure(path.error());
  asio::io_context io;
  asio::local::stream_protocol::socket socket(io);
  asio::error_code error;
  socket.connect(asio::local::stream_protocol::endpoint(*path), error);
  if (error) {
    return failure(*path + ": " + error.message() + ": no server of this user runs that world");
  }
  asio::write(socket, asio::buffer(line), error);
  std::string in;
  while (!error) {
    const std::size_t bytes = asio::read_until(socket, asio::dynamic_buffer(in), '\n', error);
    if (error) break;
    const std::string answer = in.substr(0, bytes - 1);
    in.erase(0, bytes);
    if (answer == "=ok") return ControlEnd::done;
    if (answer == "=error") return ControlEnd::refused;
    if (answer == "=unsaved") return ControlEnd::unsaved;
    out << (answer.starts_with('|') ? answer.substr(1) : answer) << std::endl;
  }
  return failure(*path + ": the server ended before its answer was complete");
}

}  // namespace runstone
