#include "client/session/library_exchange.hpp"

#include <algorithm>
#include <utility>

#include "common/core/assert.hpp"
#include "common/core/text.hpp"

namespace runstone {
namespace {

constexpr std::uint64_t kMib = std::uint64_t{1} << 20;

std::string too_large_text(std::uint64_t file_bytes) {
  return "the file of the build has " + std::to_string((file_bytes + kMib - 1) / kMib) +
         " MiB; this client takes at most " +
         std::to_string(LibraryExchange::kFileBytesMax / kMib) + " MiB";
}

constexpr const char* kNoAnswer = "the server did not answer in time: try it again";

}  // namespace

// Orders of the player.

void LibraryExchange::list(LibrarySearch search) {
  search.name = cut_utf8(search.name, kBuildNameBytesMax);
  search.author = cut_utf8(search.author, kBuildAuthorBytesMax);
  search.tag = cut_utf8(search.tag, kBuildTagBytesMax);
  listing_.search = std::move(search);
  listing_.is_waiting = true;
  listing_.refusal.clear();
  wanted_page_ = Page::first;
  ++serial_;
}

void LibraryExchange::list_more() {
  if (listing_.is_waiting || !listing_.has_more || listing_.builds.empty()) return;
  listing_.is_waiting = true;
  listing_.refusal.clear();
  wanted_page_ = Page::next;
  ++serial_;
}

void LibraryExchange::fetch(Sequence number) {
  stop_fetch();
  ++fetches_;
  fetch_.state = TransferState::under_way;
  fetch_.number = number;
  asked_bytes_ = 0;
  fetch_us_.reset();
  const auto listed =
      std::find_if(listing_.builds.begin(), listing_.builds.end(),
                   [&](const ListedBuild& build) { return build.number == number; });
  if (listed != listing_.builds.end()) return set_file_bytes(listed->file_bytes);
  if (number == 0 || number >= kSequenceMax)
    return fail_fetch("there is no build " + std::to_string(number));
  is_look_up_wanted_ = true;
}

void LibraryExchange::stop_fetch() {
  // An answer to a look-up is ignored while no fetch waits for its size.
  fetch_ = {};
  is_look_up_wanted_ = false;
  ++serial_;
}

void LibraryExchange::add(Bytes file) {
  RUNSTONE_ASSERT(!file.empty());
  stop_adding();
  addition_.state = TransferState::under_way;
  addition_.file_bytes = file.size();
  if (file.size() > kFileBytesMax) return fail_addition(too_large_text(file.size()));
  file_ = std::move(file);
}

void LibraryExchange::stop_adding() {
  addition_ = {};
  file_ = {};
  sent_bytes_ = 0;
  offer_ = 0;
  is_offer_accepted_ = false;
  ++serial_;
}

Bytes LibraryExchange::take_file() {
  RUNSTONE_ASSERT(fetch_.state == TransferState::done);
  Bytes out = std::move(fetch_.bytes);
  fetch_ = {};
  return out;
}

bool LibraryExchange::is_busy() const {
  return listing_.is_waiting || fetch_.state == TransferState::under_way ||
         addition_.state == TransferState::under_way;
}

// Requests.

std::vector<Message> LibraryExchange::step(TimeUs now_us) {
  std::vector<Message> out;
  if (pending_page_ && now_us - pending_page_->sent_us >= kListUsMax) {
    const Page page = std::exchange(pending_page_, std::nullopt)->page;
    if (page != Page::look_up) {
      fail_listing(kNoAnswer);
    } else if (fetch_.state == TransferState::under_way && fetch_.file_bytes == 0) {
      fail_fetch(kNoAnswer);
    }
  }
  ask_for_page(out, now_us);
  if (fetch_.state == TransferState::under_way && fetch_.file_bytes != 0)
    ask_for_pieces(out, now_us);
  if (addition_.state == TransferState::under_way) send_uploads(out, now_us);
  return out;
}

void LibraryExchange::ask_for_page(std::vector<Message>& out, TimeUs now_us) {
  // The server may drop an earlier request. A page may be dropped, but a look-up may not.
  const bool looks_up = pending_page_ && pending_page_->page == Page::look_up;
  if (wanted_page_ && !looks_up) {
    BuildsRequest request;
    request.request = ++requests_;
    request.name = listing_.search.name;
    request.author = listing_.search.author;
    request.tag = listing_.search.tag;
    if (*wanted_page_ == Page::next) request.before = listing_.builds.back().number;
    request.count = static_cast<std::uint8_t>(kListedBuildsMax);
    out.emplace_back(std::move(request));
    pending_page_ = PendingPage{requests_, *std::exchange(wanted_page_, std::nullopt), now_us};
  } else if (is_look_up_wanted_ && !pending_page_) {
    BuildsRequest request;
    request.request = ++requests_;
    request.before = fetch_.number + 1;
    request.count = 1;
    out.emplace_back(std::move(request));
    pending_page_ = PendingPage{requests_, Page::look_up, now_us};
    is_look_up_wanted_ = false;
  }
}

void LibraryExchange::ask_for_pieces(std::vector<Message>& out, TimeUs now_us) {
  if (!fetch_us_) fetch_us_ = now_us;
  if (now_us - *fetch_us_ >= kFetchUsMax) {
    pieces_.clear();
    return fail_fetch(kNoAnswer);
  }
  while (pieces_.size() < kUnderWayMax && asked_bytes_ < fetch_.file_bytes) {
    pieces_.push_back({++requests_, asked_bytes_, fetches_});
    out.emplace_back(BuildPieceRequest{requests_, fetch_.number, asked_bytes_});
    asked_bytes_ += kBuildPieceBytes;
  }
}

void LibraryExchange::send_uploads(std::vector<Message>& out, TimeUs now_us) {
  if (offer_ == 0) {
    offer_ = ++requests_;
    add_us_ = now_us;
    out.emplace_back(BuildOffer{offer_, file_.size()});
    return;
  }
  if (now_us - add_us_ >= kAddUsMax) return fail_addition(kNoAnswer);
  if (!is_offer_accepted_) return;
  const auto has_room = [this] {
    return sent_bytes_ - addition_.received_bytes <=
           (kUnderWayMax - 1) * std::uint64_t{kBuildUploadBytesMax};
  };
  while (sent_bytes_ < file_.size() && has_room()) {
    BuildUpload upload;
    upload.request = offer_;
    upload.offset = sent_bytes_;
    const std::uint64_t end =
        std::min<std::uint64_t>(file_.size(), sent_bytes_ + kBuildUploadBytesMax);
    upload.bytes.assign(file_.begin() + static_cast<std::ptrdiff_t>(sent_bytes_),
                        file_.begin() + static_cast<std::ptrdiff_t>(end));
    sent_bytes_ = end;
    out.emplace_back(std::move(upload));
  }
}

// Answers.

void LibraryExchange::receive(Builds answer, TimeUs /*now_us*/) {
  if (!pending_page_ || pending_page_->request != answer.request) return;
  const Page page = std::exchange(pending_page_, std::nullopt)->page;
  if (page == Page::look_up) return take_look_up(answer);
  // A newer listing waits to be sent.
  if (wanted_page_) return;
  take_page(page, std::move(answer));
}

void LibraryExchange::take_page(Page page, Builds answer) {
  if (!answer.refusal.empty()) return fail_listing(with_unseen_replaced(answer.refusal));
  std::vector<ListedBuild>& builds = listing_.builds;
  if (page == Page::first) builds.clear();
  if (!builds.empty() && !answer.builds.empty() &&
      answer.builds.front().number >= builds.back().number)
    return fail_listing("the server sent builds again that are in the list");
  for (ListedBuild& build : answer.builds) {
    if (builds.size() < kListedMax) builds.push_back(std::move(build));
  }
  listing_.has_more = answer.has_more && !builds.empty() && builds.size() < kListedMax;
  listing_.total = answer.total;
  listing_.is_waiting = false;
  listing_.is_known = true;
  ++serial_;
}

void LibraryExchange::take_look_up(const Builds& answer) {
  if (fetch_.state != TransferState::under_way || fetch_.file_bytes != 0) return;
  // The answer may be that of a fetch that was dropped. Then the look-up of the newest one follows.
  if (is_look_up_wanted_) return;
  if (!answer.refusal.empty()) return fail_fetch(with_unseen_replaced(answer.refusal));
  if (answer.builds.empty() || answer.builds.front().number != fetch_.number)
    return fail_fetch("there is no build " + std::to_string(fetch_.number));
  set_file_bytes(answer.builds.front().file_bytes);
}

void LibraryExchange::set_file_bytes(std::uint64_t file_bytes) {
  if (file_bytes > kFileBytesMax) return fail_fetch(too_large_text(file_bytes));
  fetch_.file_bytes = file_bytes;
  ++serial_;
}

void LibraryExchange::receive(BuildPiece answer, TimeUs now_us) {
  const auto at = std::find_if(pieces_.begin(), pieces_.end(), [&](const PendingPiece& piece) {
    return piece.request == answer.request;
  });
  if (at == pieces_.end()) return;
  const PendingPiece piece = *at;
  pieces_.erase(at);
  if (piece.fetch != fetches_ || fetch_.state != TransferState::under_way) return;
  if (!answer.refusal.empty()) return fail_fetch(with_unseen_replaced(answer.refusal));
  const std::uint64_t expected =
      std::min<std::uint64_t>(kBuildPieceBytes, fetch_.file_bytes - piece.offset);
  if (piece.offset != fetch_.bytes.size() || answer.bytes.size() != expected)
    return fail_fetch("the server sent other bytes than those that were asked for");
  fetch_.bytes.insert(fetch_.bytes.end(), answer.bytes.begin(), answer.bytes.end());
  fetch_us_ = now_us;
  if (fetch_.bytes.size() == fetch_.file_bytes) fetch_.state = TransferState::done;
  ++serial_;
}

void LibraryExchange::receive(const BuildAnswer& answer, TimeUs now_us) {
  if (addition_.state != TransferState::under_way || answer.request != offer_) return;
  if (!answer.refusal.empty()) return fail_addition(with_unseen_replaced(answer.refusal));
  if (answer.received < addition_.received_bytes || answer.received > sent_bytes_ ||
      (answer.number != 0 && answer.received != file_.size()))
    return fail_addition("the server counts other bytes than those that were sent");
  add_us_ = now_us;
  is_offer_accepted_ = true;
  addition_.received_bytes = answer.received;
  if (answer.number != 0) {
    addition_.number = answer.number;
    addition_.state = TransferState::done;
    file_ = {};
  }
  ++serial_;
}

// Ends.

void LibraryExchange::fail_listing(std::string why) {
  listing_.is_waiting = false;
  listing_.refusal = std::move(why);
  wanted_page_.reset();
  ++serial_;
}

void LibraryExchange::fail_fetch(std::string why) {
  fetch_.state = TransferState::failed;
  fetch_.refusal = std::move(why);
  fetch_.bytes = {};
  is_look_up_wanted_ = false;
  ++serial_;
}

void LibraryExchange::fail_addition(std::string why) {
  addition_.state = TransferState::failed;
  addition_.refusal = std::move(why);
  file_ = {};
  ++serial_;
}

void LibraryExchange::refuse(const std::string& why) {
  if (listing_.is_waiting) fail_listing(why);
  if (fetch_.state == TransferState::under_way) fail_fetch(why);
  if (addition_.state == TransferState::under_way) fail_addition(why);
}

void LibraryExchange::disconnected() {
  const bool is_sent = !file_.empty() && sent_bytes_ == file_.size();
  if (addition_.state == TransferState::under_way && is_sent)
    fail_addition(
        "the connection ended before the answer came: see the list before you add it again");
  refuse("the connection ended");
  pending_page_.reset();
  pieces_.clear();
  requests_ = 0;
}

void LibraryExchange::clear() {
  const std::uint64_t serial = serial_;
  *this = {};
  serial_ = serial + 1;
}

}  // namespace runstone
