#include "results/history.hpp"

#include <sqlite3.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>

namespace whirl::results {
namespace {

constexpr const char* kSchema = R"sql(
CREATE TABLE IF NOT EXISTS run (
  id INTEGER PRIMARY KEY, at TEXT NOT NULL DEFAULT (datetime('now', 'localtime')),
  plan TEXT NOT NULL, verdict TEXT NOT NULL, reason TEXT NOT NULL, seed TEXT NOT NULL,
  digest TEXT NOT NULL, virtual_s REAL NOT NULL, host_s REAL NOT NULL);
CREATE TABLE IF NOT EXISTS expectation (
  run INTEGER NOT NULL REFERENCES run(id), name TEXT NOT NULL, verdict TEXT NOT NULL,
  measured REAL, margin REAL, unit TEXT NOT NULL);
CREATE INDEX IF NOT EXISTS expectation_run ON expectation(run);
)sql";

struct Close {
  void operator()(sqlite3* db) const { sqlite3_close(db); }
  void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};
using Database = std::unique_ptr<sqlite3, Close>;

class Statement {
 public:
  Statement(sqlite3* db, const char* sql) {
    sqlite3_stmt* raw = nullptr;
    if (sqlite3_prepare_v2(db, sql, -1, &raw, nullptr) == SQLITE_OK) statement_.reset(raw);
  }
  explicit operator bool() const { return statement_ != nullptr; }
  Statement& bind(const std::string& text) {
    sqlite3_bind_text(statement_.get(), ++bound_, text.c_str(), -1, SQLITE_TRANSIENT);
    return *this;
  }
  Statement& bind(double x) {  // SQLite keeps a NaN as NULL
    sqlite3_bind_double(statement_.get(), ++bound_, x);
    return *this;
  }
  Statement& bind(sqlite3_int64 x) {
    sqlite3_bind_int64(statement_.get(), ++bound_, x);
    return *this;
  }
  int step() { return sqlite3_step(statement_.get()); }
  void again() {
    sqlite3_reset(statement_.get());
    bound_ = 0;
  }
  std::string text(int column) const {
    const auto* words = sqlite3_column_text(statement_.get(), column);
    return words == nullptr ? "" : reinterpret_cast<const char*>(words);
  }
  double real(int column) const {
    return sqlite3_column_type(statement_.get(), column) == SQLITE_NULL
               ? std::numeric_limits<double>::quiet_NaN()
               : sqlite3_column_double(statement_.get(), column);
  }

 private:
  std::unique_ptr<sqlite3_stmt, Close> statement_;
  int bound_ = 0;
};

Error complaint(const std::string& file, sqlite3* db) {
  return {ErrorKind::host, file, db == nullptr ? "cannot be opened" : sqlite3_errmsg(db),
          "the history is only a record; move the file away to begin a new one"};
}

Result<Database> open(const std::string& file) {
  sqlite3* raw = nullptr;
  const int status = sqlite3_open(file.c_str(), &raw);
  Database db(raw);
  if (status != SQLITE_OK) return complaint(file, raw);
  sqlite3_busy_timeout(raw, 10'000);  // other runs may be writing
  if (sqlite3_exec(raw, kSchema, nullptr, nullptr, nullptr) != SQLITE_OK)
    return complaint(file, raw);
  return db;
}

bool insert(sqlite3* db, const Report& r) {
  Statement run(db,
                "INSERT INTO run(plan, verdict, reason, seed, digest, virtual_s, host_s) "
                "VALUES (?, ?, ?, ?, ?, ?, ?)");
  if (!run) return false;
  run.bind(r.plan).bind(name(r.verdict)).bind(r.reason).bind(std::to_string(r.seed)).bind(r.digest);
  if (run.bind(r.virtual_s).bind(r.host.total_s).step() != SQLITE_DONE) return false;
  const sqlite3_int64 id = sqlite3_last_insert_rowid(db);
  Statement row(db, "INSERT INTO expectation VALUES (?, ?, ?, ?, ?, ?)");
  if (!row) return false;
  for (const Expectation& e : r.expectations) {
    row.bind(id).bind(e.name).bind(name(e.verdict)).bind(e.measured).bind(e.margin).bind(e.unit);
    if (row.step() != SQLITE_DONE) return false;
    row.again();
  }
  return true;
}

}  // namespace

Result<Done> remember(const std::string& file, const Report& report) {
  auto db = open(file);
  if (!db) return db.error();
  sqlite3* raw = db.value().get();
  sqlite3_exec(raw, "BEGIN IMMEDIATE", nullptr, nullptr, nullptr);
  if (!insert(raw, report)) {
    const Error error = complaint(file, raw);
    sqlite3_exec(raw, "ROLLBACK", nullptr, nullptr, nullptr);
    return error;
  }
  if (sqlite3_exec(raw, "COMMIT", nullptr, nullptr, nullptr) != SQLITE_OK)
    return complaint(file, raw);
  return Done{};
}

Result<std::vector<PastExpectation>> recall(const std::string& file, const std::string& plan,
                                            const std::string& expectation, int runs) {
  if (!std::filesystem::exists(file)) {
    return Error{ErrorKind::bad_input, file, "no history yet", "whirl run makes it"};
  }
  auto db = open(file);
  if (!db) return db.error();
  Statement query(db.value().get(), R"sql(
    SELECT at, plan, name, verdict, unit, seed, measured, margin FROM (
      SELECT run.at, run.id, plan, name, e.verdict, unit, seed, measured, margin,
             row_number() OVER (PARTITION BY plan, name ORDER BY run.id DESC) AS age
      FROM expectation e JOIN run ON run.id = e.run
      WHERE (?1 = '' OR plan = ?1) AND (?2 = '' OR instr(name, ?2) > 0))
    WHERE age <= ?3 ORDER BY plan, name, id)sql");
  if (!query) return complaint(file, db.value().get());
  query.bind(plan).bind(expectation).bind(static_cast<sqlite3_int64>(runs));
  std::vector<PastExpectation> rows;
  while (query.step() == SQLITE_ROW) {
    rows.push_back({query.text(0), query.text(1), query.text(2), query.text(3), query.text(4),
                    query.text(5), query.real(6), query.real(7)});
  }
  return rows;
}

}  // namespace whirl::results
