#include "server/store/rights_table.hpp"

#include "server/store/record_checksum.hpp"
#include "server/store/sql_result.hpp"

namespace runstone {

StoreResult<RightsTable> RightsTable::open(sql::Database& database) {
  auto all = database.prepare("SELECT seq, record, checksum FROM rights_record ORDER BY seq");
  if (!all) return failed(all.error());
  auto insert =
      database.prepare("INSERT INTO rights_record(seq, record, checksum) VALUES(?1, ?2, ?3)");
  if (!insert) return failed(insert.error());
  return RightsTable(database.file(), *std::move(all), *std::move(insert));
}

StoreResult<FoldedRows<EditRecord>> RightsTable::records() {
  const sql::ResetAtEnd reset_at_end(all_);
  FoldedRows<EditRecord> out;
  for (;;) {
    const auto more = all_.step();
    if (!more) return failed(more.error());
    if (!*more) return out;
    const std::int64_t seq = all_.integer(0);
    auto record = decode_record(all_.blob(1));
    const bool is_sound =
        record && static_cast<std::int64_t>(record->version.seq) == seq &&
        static_cast<std::int64_t>(record_checksum(*record)) == all_.integer(2) &&
        (rights_change_of(record->edit) != nullptr || given_texture_of(record->edit) != nullptr);
    if (!is_sound) {
      return failure(StoreError{StoreError::Kind::corrupt, file_,
                                "rights_record seq=" + std::to_string(seq),
                                "checksum or encoding is wrong"});
    }
    out.rows.push_back(*std::move(record));
    add_row(out.fold, all_.integer(2));
  }
}

StoreResult<void> RightsTable::add(const EditRecord& record, RowFold& fold) {
  const auto checksum = static_cast<std::int64_t>(record_checksum(record));
  add_row(fold, checksum);
  const Bytes bytes = encode_record(record);
  return store_result(insert_.bind(1, static_cast<std::int64_t>(record.version.seq))
                          .bind(2, ByteView(bytes))
                          .bind(3, checksum)
                          .run());
}

}  // namespace runstone
