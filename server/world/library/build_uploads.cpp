#include "server/world/library/build_uploads.hpp"

#include <algorithm>
#include <utility>

#include "common/core/address_block.hpp"
#include "common/core/text.hpp"
#include "protocol/limits.hpp"

namespace runstone {
namespace {

// Bytes are kept in pieces of this size, so that no large block is moved on the world strand.
constexpr std::size_t kUploadPartBytes = std::size_t{1} << 20;

/// Returns true if an address is that of one household or so, and known.
bool is_of_one_owner(AddressBlock address) {
  constexpr auto kUnknown = AddressBlock{};
  constexpr std::uint64_t kLoopback = std::uint64_t{127} << 24;
  const auto bits = static_cast<std::uint64_t>(address);
  const bool is_loopback = bits >> 32 == 0xffff && (bits & 0xff00'0000) == kLoopback;
  return address != kUnknown && !is_loopback && !is_of_local_network(address);
}

void append(std::vector<Bytes>& parts, ByteView bytes, std::uint64_t left) {
  while (!bytes.empty()) {
    if (parts.empty() || parts.back().size() == kUploadPartBytes) {
      parts.emplace_back();
      parts.back().reserve(
          static_cast<std::size_t>(std::min<std::uint64_t>(left, kUploadPartBytes)));
    }
    Bytes& last = parts.back();
    const std::size_t count = std::min(bytes.size(), kUploadPartBytes - last.size());
    last.insert(last.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count));
    bytes = bytes.subspan(count);
    left -= count;
  }
}

}  // namespace

/// Returns why the player may not add a file of so many bytes now, as a sentence without its period.
std::optional<std::string> BuildUploads::refusal(const Session& session,
                                                 std::uint64_t file_bytes) const {
  const Order& order = world_.order;
  if (order.is_following())
    return "this server follows the owner of the world: add builds there (servers lists them)";
  if (const auto frozen = world_.rights.freeze_text(session.key)) return frozen;
  if (!world_.rights.decide(session.key, Right::build).is_allowed)
    return "your role does not allow to build, so you may not add builds";
  if (auto why = order.library().refusal(session.author, file_bytes)) return why;
  if (auto why = world_.cluster.library_refusal()) return why;
  if (!order.accepts_edits()) return "the server takes no changes of the world now";
  if (order.is_disk_full()) return order.disk_reason();
  return std::nullopt;
}

/// Returns why there is no room for the file of this session, or nullopt.
std::optional<std::string> BuildUploads::slot_refusal(const Session& session,
                                                      const Clocks& now) const {
  for (const Upload& other : uploads_) {
    if (other.key == session.key) return "a build that you add is under way: wait until it is done";
    if (other.address == session.address && is_of_one_owner(other.address))
      return "a build from your address is being added: try again when it is done";
  }
  for (const Pause& pause : pauses_) {
    if (now.steady_us >= pause.until_us) continue;
    const bool is_mine = pause.key == session.key ||
                         (pause.address == session.address && is_of_one_owner(pause.address));
    if (is_mine) {
      return "your last file was not added and kept others waiting: try again in " +
             std::to_string((pause.until_us - now.steady_us + 999'999) / 1'000'000) + " s";
    }
  }
  if (uploads_.size() < kBuildUploadsMax) return std::nullopt;
  return "other players are adding builds: try again in a minute";
}

BuildUploads::Upload* BuildUploads::find(UploadNumber upload) {
  const auto found = std::ranges::find(uploads_, upload, &Upload::number);
  return found == uploads_.end() ? nullptr : &*found;
}

void BuildUploads::remove(UploadNumber upload) {
  std::erase_if(uploads_, [upload](const Upload& one) { return one.number == upload; });
}

void BuildUploads::answer(Session& session, const BuildAnswer& answer) {
  world_.sessions.send_or_close(session, answer);
}

/// A file that was not added does not hold its place again before it was free for as long, so that two
/// players cannot keep all others out.
void BuildUploads::pause_after(const Upload& upload) {
  const TimeUs held_us = std::min(now_us_ - upload.began_us, kUploadPauseUsMax);
  if (held_us < kUploadSilenceUs) return;
  if (pauses_.size() == kUploadPausesMax) pauses_.erase(pauses_.begin());
  pauses_.push_back({upload.key, upload.address, now_us_ + held_us});
}

void BuildUploads::refuse(const Upload& upload, const std::string& why) {
  pause_after(upload);
  Session* const session = upload.session ? world_.sessions.find(*upload.session) : nullptr;
  const BuildAnswer refused{upload.request, upload.received, 0,
                            std::string(cut_utf8(why, kTextBytesMax))};
  remove(upload.number);
  if (session != nullptr) answer(*session, refused);
}

void BuildUploads::end_offer(SessionId session) {
  const auto mine = std::ranges::find(uploads_, std::optional(session), &Upload::session);
  if (mine == uploads_.end()) return;
  if (mine->stage == Stage::receiving || mine->stage == Stage::waiting) {
    pause_after(*mine);
    uploads_.erase(mine);
  } else {
    mine->session.reset();
  }
}

void BuildUploads::on_offer(Session& session, const BuildOffer& offer, const Clocks& now) {
  now_us_ = now.steady_us;
  end_offer(session.id);
  auto why = refusal(session, offer.file_bytes);
  if (!why) why = slot_refusal(session, now);
  if (why) {
    return answer(session, {offer.request, 0, 0, std::string(cut_utf8(*why, kTextBytesMax))});
  }
  Upload upload;
  upload.number = UploadNumber{++last_number_};
  upload.session = session.id;
  upload.request = offer.request;
  upload.file_bytes = offer.file_bytes;
  upload.key = session.key;
  upload.address = session.address;
  upload.began_us = upload.heard_us = now.steady_us;
  uploads_.push_back(std::move(upload));
  answer(session, {offer.request, 0, 0, ""});
}

BuildUploads::Upload* BuildUploads::receiving(SessionId session, const BuildUpload& upload) {
  const auto mine = std::ranges::find(uploads_, std::optional(session), &Upload::session);
  const bool fits = mine != uploads_.end() && mine->stage == Stage::receiving &&
                    mine->request == upload.request && mine->received == upload.offset &&
                    upload.bytes.size() <= mine->file_bytes - mine->received;
  return fits ? &*mine : nullptr;
}

void BuildUploads::on_upload(Session& session, const BuildUpload& upload, const Clocks& now) {
  Upload* const mine = receiving(session.id, upload);
  if (mine == nullptr) return;
  append(mine->parts, upload.bytes, mine->file_bytes - mine->received);
  mine->received += upload.bytes.size();
  mine->heard_us = now.steady_us;
  if (mine->received == mine->file_bytes) {
    mine->stage = Stage::verifying;
    world_.environment.verify_build(mine->number, std::exchange(mine->parts, {}));
  }
  answer(session, {mine->request, mine->received, 0, ""});
}

void BuildUploads::verified(UploadNumber number, Result<VerifiedBuild, std::string> result,
                            const Clocks& now) {
  Upload* const upload = find(number);
  if (upload == nullptr) return;
  const Session* const session =
      upload->session ? std::as_const(world_.sessions).find(*upload->session) : nullptr;
  if (session == nullptr) {
    pause_after(*upload);
    return remove(number);
  }
  if (!result) return refuse(*upload, result.error());
  upload->build = std::move(result->build);
  upload->build.info.author = is_plain_name(session->name) ? session->name : std::string();
  upload->build.content = world_.changes.next_build_content();
  upload->file = std::move(result->file);
  upload->stage = Stage::waiting;
  upload->heard_us = now.steady_us;
  if (const auto why = begin_saving(*upload)) refuse(*upload, *why);
}

std::optional<std::string> BuildUploads::begin_saving(Upload& upload) {
  const Session* const session = std::as_const(world_.sessions).find(*upload.session);
  if (session == nullptr) return "the session has ended";
  if (auto why = refusal(*session, upload.file_bytes)) return why;
  if (!world_.environment.save_build_file(upload.number, upload.build.content, upload.file))
    return std::nullopt;
  upload.stage = Stage::saving;
  upload.file.reset();
  return std::nullopt;
}

/// Orders the addition of a build whose file is on disk.
Result<Sequence, std::string> BuildUploads::add(const Upload& upload, const Clocks& now) {
  const Session* const session =
      upload.session ? std::as_const(world_.sessions).find(*upload.session) : nullptr;
  if (session == nullptr) return failure("the session has ended");
  if (const auto why = refusal(*session, upload.file_bytes)) return failure(*why);
  return world_.changes.add_build(upload.build, session->author, now);
}

void BuildUploads::saved(UploadNumber number, const std::string& error, const Clocks& now) {
  Upload* const upload = find(number);
  if (upload == nullptr) return;
  const auto added =
      error.empty() ? add(*upload, now) : Result<Sequence, std::string>(failure(error));
  if (!added) {
    // Parts of the file may be on disk also after an error.
    world_.environment.remove_build_file(upload->build.content);
    return refuse(*upload, added.error());
  }
  added_.push_back({*upload->session, upload->request, upload->file_bytes, *added});
  remove(number);
  send_durable();
}

void BuildUploads::send_durable() {
  if (added_.empty()) return;
  const bool is_lost = world_.order.ownership().is(OwnershipState::log_lost);
  const auto is_decided = [&](const Added& one) {
    if (one.number > world_.order.durable() && !is_lost) return false;
    Session* const session = world_.sessions.find(one.session);
    if (session == nullptr) return true;
    if (one.number <= world_.order.durable()) {
      answer(*session, {one.request, one.file_bytes, one.number, ""});
    } else {
      answer(*session, {one.request, one.file_bytes, 0, "the log cannot be written any more"});
    }
    return true;
  };
  std::erase_if(added_, is_decided);
}

/// Returns why the upload takes too long, or nullopt.
std::optional<std::string> BuildUploads::lateness(const Upload& upload, const Clocks& now) const {
  const TimeUs silent_us = now.steady_us - upload.heard_us;
  if (upload.stage == Stage::waiting) {
    if (silent_us < kUploadWriterUs) return std::nullopt;
    return "other files are being written, or the world cannot be written: try again";
  }
  if (upload.stage != Stage::receiving) return std::nullopt;
  if (silent_us >= kUploadSilenceUs) return "no byte of the file came for 30 s";
  const auto file_us = static_cast<TimeUs>(upload.file_bytes * 1'000'000 / kUploadBytesPerSecond);
  if (now.steady_us - upload.began_us < file_us + kUploadSilenceUs) return std::nullopt;
  return "the file came too slowly: at least 32 KiB each second are needed";
}

void BuildUploads::tick(const Clocks& now) {
  now_us_ = now.steady_us;
  std::vector<UploadNumber> numbers;
  for (const Upload& upload : uploads_) numbers.push_back(upload.number);
  for (const UploadNumber number : numbers) {
    Upload* const upload = find(number);
    if (upload == nullptr) continue;
    auto why = lateness(*upload, now);
    if (!why && upload->stage == Stage::waiting) why = begin_saving(*upload);
    if (why) refuse(*upload, *why);
  }
  send_durable();
}

}  // namespace runstone
