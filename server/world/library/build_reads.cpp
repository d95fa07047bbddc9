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

void BuildReads::send(const Session& session, SessionReads& reads, const Message& message) {
  EncodedMessage encoded = encode_message(message);
  if (reads.unsent.empty() && sessions_.send(session, encoded)) return;
  reads.unsent.push_back(std::move(encoded));
}

bool BuildReads::send_unsent(const Session& session, SessionReads& reads) {
  while (!reads.unsent.empty() && sessions_.send(session, reads.unsent.front()))
    reads.unsent.pop_front();
  return reads.unsent.empty();
}

void BuildReads::serve(const Session& session, SessionReads& reads, const Clocks& now) {
  if (!send_unsent(session, reads)) return;
  const bool may_list = reads.list && !reads.is_list_read && now.steady_us >= reads.list_due_us;
  if (may_list && lists_read_ < kBuildListsRead) {
    reads.list_due_us = now.steady_us + config_.view_interval_us;
    const BuildsRequest request = *std::exchange(reads.list, std::nullopt);
    if (const auto why = refusal(session)) {
      Builds refused;
      refused.request = request.request;
      refused.refusal = refusal_line(*why);
      send(session, reads, refused);
    } else {
      reads.is_list_read = true;
      ++lists_read_;
      sessions_.charge_reading(session, request.count * kListedBuildBytes);
      environment_.find_builds(session.id, request);
    }
  }
  while (!reads.is_piece_read && !reads.pieces.empty() && pieces_read_ < kBuildPiecesRead) {
    const BuildPieceRequest request = reads.pieces.front();
    if (const auto why = refusal(session, request)) {
      reads.pieces.pop_front();
      send(session, reads, refused_piece(request, *why));
      continue;
    }
    reads.is_piece_read = true;
    ++pieces_read_;
    const std::uint64_t left = order_.library().find(request.number)->file_bytes - request.offset;
    sessions_.charge_reading(
        session, static_cast<std::size_t>(std::min<std::uint64_t>(left, kBuildPieceBytes)));
    environment_.read_build_piece(session.id, request);
  }
}

void BuildReads::serve(const Clocks& now) {
  auto next = by_session_.upper_bound(last_served_);
  for (std::size_t left = by_session_.size(); left > 0; --left, ++next) {
    if (next == by_session_.end()) next = by_session_.begin();
    const Session* const session = std::as_const(sessions_).find(next->first);
    if (session == nullptr) continue;
    const std::size_t reads_before = lists_read_ + pieces_read_;
    serve(*session, next->second, now);
    if (lists_read_ + pieces_read_ != reads_before) last_served_ = session->id;
  }
}

void BuildReads::on_request(Session& session, const BuildsRequest& request, const Clocks& now) {
  by_session_[session.id].list = request;
  serve(now);
}

void BuildReads::on_piece_request(Session& session, const BuildPieceRequest& request,
                                  const Clocks& now) {
  SessionReads& reads = by_session_[session.id];
  if (reads.pieces.size() + reads.unsent.size() < kBuildPiecesMax) {
    reads.pieces.push_back(request);
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
  if (mine != nullptr && by_session_.contains(session)) {
    SessionReads& reads = by_session_.at(session);
    reads.is_list_read = false;
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
    send(*mine, reads, answer);
  }
  serve(now);
}

void BuildReads::piece_read(SessionId session, std::uint32_t request,
                            Result<Bytes, std::string> piece, const Clocks& now) {
  --pieces_read_;
  const Session* const mine = std::as_const(sessions_).find(session);
  if (mine != nullptr && by_session_.contains(session)) {
    SessionReads& reads = by_session_.at(session);
    reads.is_piece_read = false;
    reads.pieces.pop_front();
    BuildPiece answer;
    answer.request = request;
    if (piece) {
      answer.bytes = *std::move(piece);
    } else {
      answer.refusal = refusal_line(piece.error());
    }
    send(*mine, reads, answer);
  }
  serve(now);
}

}  // namespace runstone
