#include "server/world/library/build_reads.hpp"

#include <algorithm>
#include <utility>

#include "common/core/text.hpp"
#include "protocol/limits.hpp"

namespace runstone {
namespace {

std::string refusal_line(const std::string& why) {
  return std::string(cut_utf8(why, kTextBytesMax));
}

BuildPiece refused_piece(const BuildPieceRequest& request, const std::string& why) {
  BuildPiece out;
  out.request = request.request;
  out.refusal = refusal_line(why);
  return out;
}

}  // namespace

std::optional<std::string> BuildReads::refusal(const Session& session) const {
  if (rights_.decide(session.key, Right::see).is_allowed) return std::nullopt;
  return "your role does not allow to see the world";
}

std::optional<std::string> BuildReads::refusal(const Session& session,
                                               const BuildPieceRequest& request) const {
  if (auto why = refusal(session)) return why;
  const LibraryRow* const row = order_.library().find(request.number);
  if (row == nullptr) return "the library has no build " + std::to_string(request.number);
  if (request.offset < row->file_bytes) return std::nullopt;
  return "the file of build " + std::to_string(request.number) + " ends at byte " +
         std::to_string(row->file_bytes);
}

void BuildReads::send(const Session& session, Of& of, const Message& message) {
  EncodedMessage encoded = encode_message(message);
  if (of.unsent.empty() && sessions_.send(session, encoded)) return;
  of.unsent.push_back(std::move(encoded));
}

bool BuildReads::send_unsent(const Session& session, Of& of) {
  while (!of.unsent.empty() && sessions_.send(session, of.unsent.front())) of.unsent.pop_front();
  return of.unsent.empty();
}

void BuildReads::serve(const Session& session, Of& of, const Clocks& now) {
  if (!send_unsent(session, of)) return;
  const bool may_list = of.list && !of.is_list_read && now.steady_us >= of.list_due_us;
  if (may_list && lists_read_ < kBuildListsRead) {
    of.list_due_us = now.steady_us + config_.view_interval_us;
    const BuildsRequest request = *std::exchange(of.list, std::nullopt);
    if (const auto why = refusal(session)) {
      Builds refused;
      refused.request = request.request;
      refused.refusal = refusal_line(*why);
      send(session, of, refused);
    } else {
      of.is_list_read = true;
      ++lists_read_;
      sessions_.charge_reading(session, request.count * kListedBuildBytes);
      environment_.find_builds(session.id, request);
    }
  }
  while (!of.is_piece_read && !of.pieces.empty() && pieces_read_ < kBuildPiecesRead) {
    const BuildPieceRequest request = of.pieces.front();
    if (const auto why = refusal(session, request)) {
      of.pieces.pop_front();
      send(session, of, refused_piece(request, *why));
      continue;
    }
    of.is_piece_read = true;
    ++pieces_read_;
    const std::uint64_t left = order_.library().find(request.number)->file_bytes - request.offset;
    sessions_.charge_reading(
        session, static_cast<std::size_t>(std::min<std::uint64_t>(left, kBuildPieceBytes)));
    environment_.read_build_piece(session.id, request);
  }
}

void BuildReads::serve(const Clocks& now) {
  auto next = of_.upper_bound(last_served_);
  for (std::size_t left = of_.size(); left > 0; --left, ++next) {
    if (next == of_.end()) next = of_.begin();
    const Session* const session = std::as_const(sessions_).find(next->first);
    if (session == nullptr) continue;
    const std::size_t reads = lists_read_ + pieces_read_;
    serve(*session, next->second, now);
    if (lists_read_ + pieces_read_ != reads) last_served_ = session->id;
  }
}

void BuildReads::on_request(Session& session, const BuildsRequest& request, const Clocks& now) {
  of_[session.id].list = request;
  serve(now);
}

void BuildReads::on_piece_request(Session& session, const BuildPieceRequest& request,
                                  const Clocks& now) {
  Of& of = of_[session.id];
  if (of.pieces.size() + of.unsent.size() < kBuildPiecesMax) {
    of.pieces.push_back(request);
    return serve(now);
  }
  // The answer is dropped if the queue of the session is full: only a client that sends more
  // requests than it may gets one.
  const BuildPiece refused = refused_piece(
      request, "at most " + std::to_string(kBuildPiecesMax) +
                   " pieces may be under way: wait for an answer before the next request");
  sessions_.send_or_skip(session, encode_message(refused));
}

void BuildReads::found(SessionId session, std::uint32_t request,
                       Result<FoundBuilds, std::string> found, const Clocks& now) {
  --lists_read_;
  const Session* const mine = std::as_const(sessions_).find(session);
  if (mine != nullptr && of_.contains(session)) {
    Of& of = of_.at(session);
    of.is_list_read = false;
    Builds answer;
    answer.request = request;
    if (found) {
      answer.builds = std::move(found->builds);
      answer.has_more = found->has_more;
      answer.total = order_.library().total().builds;
      const Players& players = order_.players();
      for (ListedBuild& build : answer.builds) {
        const auto key = players.key_of(build.added_by);
        if (auto name = key ? players.name_of(*key) : std::nullopt)
          build.added_by_name = *std::move(name);
      }
    } else {
      answer.refusal = refusal_line(found.error());
    }
    send(*mine, of, answer);
  }
  serve(now);
}

void BuildReads::piece_read(SessionId session, std::uint32_t request,
                            Result<Bytes, std::string> piece, const Clocks& now) {
  --pieces_read_;
  const Session* const mine = std::as_const(sessions_).find(session);
  if (mine != nullptr && of_.contains(session)) {
    Of& of = of_.at(session);
    of.is_piece_read = false;
    of.pieces.pop_front();
    BuildPiece answer;
    answer.request = request;
    if (piece) {
      answer.bytes = *std::move(piece);
    } else {
      answer.refusal = refusal_line(piece.error());
    }
    send(*mine, of, answer);
  }
  serve(now);
}

}  // namespace runstone
