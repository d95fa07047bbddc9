#include "server/web/page_link.hpp"

#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>
#include <chrono>
#include <memory>

namespace runstone {
namespace {

// A picture of 4 MiB in hex.
constexpr std::size_t kPageReplyBytesMax = std::size_t{9} << 20;

}  // namespace

std::string PageReply::value(std::string_view name) const {
  for (const std::string& line : lines) {
    if (line.size() > name.size() && line.starts_with(name) && line[name.size()] == ' ')
      return line.substr(name.size() + 1);
  }
  return "";
}

bool is_whole_page_reply(std::string_view text) {
  if (!text.ends_with('\n')) return false;
  text.remove_suffix(1);
  const std::size_t before = text.rfind('\n');
  return text.substr(before == std::string_view::npos ? 0 : before + 1).starts_with('=');
}

PageReply parse_page_reply(std::string_view text) {
  PageReply out;
  out.end = PageReply::End::late;
  bool is_first = true;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) break;  // half a line
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end + 1);
    if (line == "=ok") out.end = PageReply::End::ok;
    if (line == "=error") out.end = PageReply::End::refused;
    if (line == "=unsaved") out.end = PageReply::End::unsaved;
    if (!line.starts_with('|')) continue;
    const std::string_view said = line.substr(1);
    if (!is_first) {
      out.lines.emplace_back(said);
      continue;
    }
    is_first = false;
    if (said == "!known") out.kind = PageReply::Kind::known;
    if (said == "!unknown") out.kind = PageReply::Kind::unknown;
    if (said == "!barred") out.kind = PageReply::Kind::barred;
  }
  return out;
}

boost::asio::awaitable<PageReply> ask_page(boost::asio::io_context& io, std::string path,
                                           std::string line) {
  namespace net = boost::asio;
  const auto socket = std::make_shared<net::local::stream_protocol::socket>(io);
  net::steady_timer deadline(io, std::chrono::seconds(kPageAnswerSeconds));
  deadline.async_wait([socket](const boost::system::error_code& cancelled) {
    boost::system::error_code ignored;
    if (!cancelled) socket->close(ignored);
  });
  boost::system::error_code error;
  const net::local::stream_protocol::endpoint server(path);
  co_await socket->async_connect(server, net::redirect_error(net::use_awaitable, error));
  line += '\n';
  if (!error) {
    co_await net::async_write(*socket, net::buffer(line),
                              net::redirect_error(net::use_awaitable, error));
  }
  std::string answer;
  std::array<char, 4096> more{};
  while (!error && !is_whole_page_reply(answer) && answer.size() < kPageReplyBytesMax) {
    const std::size_t got = co_await socket->async_read_some(
        net::buffer(more), net::redirect_error(net::use_awaitable, error));
    answer.append(more.data(), got);
  }
  deadline.cancel();
  co_return parse_page_reply(answer);
}

}  // namespace runstone
