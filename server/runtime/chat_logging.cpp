#include "server/runtime/chat_logging.hpp"

#include <future>

#include "server/admin/world_lists.hpp"
#include "server/runtime/logging.hpp"
#include "server/world/people/chat_state.hpp"

namespace runstone {

std::unique_ptr<ChatLog> open_chat_log(const ServerConfig& config, TimeUs now_us) {
  if (config.chat_days == 0) {
    remove_chat_log(config.world);
    return nullptr;
  }
  return std::make_unique<ChatLog>(
      config.world, chat_kept_from_us(config, now_us),
      [](const std::string& line) { logger("store").warn("{}", line); });
}

TimeUs chat_kept_from_us(const ServerConfig& config, TimeUs now_us) {
  constexpr TimeUs kDayUs = 86'400'000'000;
  return now_us - static_cast<TimeUs>(config.chat_days) * kDayUs;
}

std::vector<ChatEntry> newest_chat(ChatLog& log) {
  // The thread of the log may still be in set_value() when the value is here.
  const auto newest = std::make_shared<std::promise<std::vector<ChatEntry>>>();
  const bool is_taken =
      log.search({"", std::nullopt, kChatKeptMax, false}, [newest](const ChatLog::Found& found) {
        newest->set_value(found ? *found : std::vector<ChatEntry>());
      });
  return is_taken ? newest->get_future().get() : std::vector<ChatEntry>();
}

void list_chat(ChatLog& log, const ChatQuery& query, const CommandReply& reply) {
  const bool is_taken = log.search(query, [reply](const ChatLog::Found& found) {
    if (!found) return refuse(reply, "chat log: " + found.error());
    reply(CommandAnswer::last(chat_list(*found)));
  });
  if (!is_taken) refuse(reply, "chat log: too many commands read it now: try again later");
}

}  // namespace runstone
