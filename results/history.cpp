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
  digest TEXT NOT NULL, virtual_s REAL NOT NULL, host_s REAL NOT NULL, inputs TEXT NOT NULL DEFAULT '');
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

// One file, and the first thing about it that went wrong: SQLite forgets it with the next call.
class History {
 public:
  static Result<History> open(const std::string& file, std::chrono::milliseconds patience);

  sqlite3* raw() const { return db_.get(); }
  // True: so far all went well.
  bool keep(int status) {
    const bool good = status == SQLITE_OK || status == SQLITE_ROW || status == SQLITE_DONE;
    if (!good && fault_.empty()) fault_ = words_for(status);
    return fault_.empty();
  }
  bool run(const char* sql) {
    return fault_.empty() && keep(sqlite3_exec(raw(), sql, nullptr, nullptr, nullptr));
  }
  void refuse(std::string fault) {
    if (fault_.empty()) fault_ = std::move(fault);
  }
  bool good() const { return fault_.empty(); }
  Error error() const {
    return {ErrorKind::host, file_, fault_,
            "the history is only a record; move the file away to begin a new one"};
  }

 private:
  explicit History(std::string file) : file_(std::move(file)) {}
  std::string words_for(int status) const {
    if ((status & 0xFF) == SQLITE_BUSY) return "is locked by another process";
    return sqlite3_errmsg(raw());
  }
  int schema();
  bool has_inputs();
  void prepare_schema();

  std::string file_, fault_;
  Database db_;
};

class Statement {
 public:
  Statement(History& history, const char* sql) : history_(history) {
    sqlite3_stmt* raw = nullptr;
    if (history_.good()) history_.keep(sqlite3_prepare_v2(history_.raw(), sql, -1, &raw, nullptr));
    statement_.reset(raw);
  }
  Statement& bind(const std::string& text) {
    sqlite3_bind_text(statement_.get(), ++bound_, text.data(), static_cast<int>(text.size()),
                      SQLITE_TRANSIENT);
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
  // True: there is a row. The end of the rows and a fault are both false: ask the history which.
  bool next() {
    if (!history_.good()) return false;
    const int status = sqlite3_step(statement_.get());
    return history_.keep(status) && status == SQLITE_ROW;
  }
  void run_again() {
    next();
    sqlite3_reset(statement_.get());
    bound_ = 0;
  }
  std::string text(int column) const {
    const auto* words = sqlite3_column_text(statement_.get(), column);
    const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column));
    return words == nullptr ? "" : std::string(reinterpret_cast<const char*>(words), size);
  }
  double real(int column) const {
    return sqlite3_column_type(statement_.get(), column) == SQLITE_NULL
               ? std::numeric_limits<double>::quiet_NaN()
               : sqlite3_column_double(statement_.get(), column);
  }
  int integer(int column) const { return sqlite3_column_int(statement_.get(), column); }

 private:
  History& history_;
  std::unique_ptr<sqlite3_stmt, Close> statement_;
  int bound_ = 0;
};

Result<History> History::open(const std::string& file, std::chrono::milliseconds patience) {
  History history(file);
  sqlite3* raw = nullptr;
  const int status = sqlite3_open(file.c_str(), &raw);
  history.db_.reset(raw);
  if (raw == nullptr) return Error{ErrorKind::host, file, "cannot be opened", ""};
  sqlite3_busy_timeout(raw, static_cast<int>(patience.count()));
  // A file may bring SQL of its own, which could work for ever: none of it is run.
  for (const int own : {SQLITE_DBCONFIG_ENABLE_TRIGGER, SQLITE_DBCONFIG_ENABLE_VIEW,
                        SQLITE_DBCONFIG_TRUSTED_SCHEMA}) {
    sqlite3_db_config(raw, own, 0, nullptr);
  }
  history.keep(status);
  history.prepare_schema();
  if (!history.good()) return history.error();
  return history;
}

int History::schema() {
  Statement version(*this, "PRAGMA user_version");
  return version.next() ? version.integer(0) : 0;
}

bool History::has_inputs() {
  Statement column(*this, "SELECT 1 FROM pragma_table_info('run') WHERE name = 'inputs'");
  return column.next();
}

void History::prepare_schema() {
  const int found = schema();
  if (found == kHistory_schema || !good()) return;
  if (found > kHistory_schema) {
    return refuse("was written by a newer whirl (schema " + std::to_string(found) +
                  ", this one knows " + std::to_string(kHistory_schema) + ")");
  }
  // New, or of before schemas had numbers, or of one that did not keep the inputs.
  run("BEGIN IMMEDIATE");
  run(kSchema);
  if (!has_inputs() && good()) run("ALTER TABLE run ADD COLUMN inputs TEXT NOT NULL DEFAULT ''");
  run(("PRAGMA user_version = " + std::to_string(kHistory_schema)).c_str());
  run("COMMIT");
}

std::string inputs_of(const Report& r) {
  std::string all;
  for (const auto& [what, version] : r.versions) {
    const std::string role = what.substr(what.find('/') + 1);  // without the node's name
    const bool is_input = role == "image" || role == "plan" || role == "board" || role == "vehicle";
    if (what.starts_with("set "))
      all += (all.empty() ? "" : ", ") + what.substr(4) + " = " + version;
    if (is_input) all += (all.empty() ? "" : ", ") + version;
  }
  return all;
}

void insert(History& history, const Report& r) {
  Statement run(history,
                "INSERT INTO run(plan, verdict, reason, seed, digest, virtual_s, host_s, inputs) "
                "VALUES (?, ?, ?, ?, ?, ?, ?, ?)");
  run.bind(r.plan).bind(name(r.verdict)).bind(r.reason).bind(std::to_string(r.seed)).bind(r.digest);
  run.bind(r.virtual_s).bind(r.host.total_s).bind(inputs_of(r)).next();
  const sqlite3_int64 id = sqlite3_last_insert_rowid(history.raw());
  Statement row(history, "INSERT INTO expectation VALUES (?, ?, ?, ?, ?, ?)");
  for (const Expectation& e : r.expectations) {
    row.bind(id).bind(e.name).bind(name(e.verdict)).bind(e.measured).bind(e.margin).bind(e.unit);
    row.run_again();
  }
}

// SQLite reads a damaged file as far as it happens to: rows may be missing without an error.
void check_integrity(History& history) {
  Statement check(history, "PRAGMA quick_check(1)");
  if (check.next() && check.text(0) != "ok") history.refuse("is damaged: " + check.text(0));
}

}  // namespace

Result<Done> remember(const std::string& file, const Report& report,
                      std::chrono::milliseconds patience) {
  auto opened = History::open(file, patience);
  if (!opened) return opened.error();
  History& history = opened.value();
  if (history.run("BEGIN IMMEDIATE")) {
    insert(history, report);
    if (history.run("COMMIT")) return Done{};
    sqlite3_exec(history.raw(), "ROLLBACK", nullptr, nullptr, nullptr);
  }
  return history.error();
}

Result<std::vector<PastExpectation>> recall(const std::string& file, const std::string& plan,
                                            const std::string& expectation, int runs,
                                            std::chrono::milliseconds patience) {
  std::error_code status;
  if (!std::filesystem::exists(file, status)) {
    return Error{ErrorKind::bad_input, file, "no history yet", "whirl run makes it"};
  }
  auto opened = History::open(file, patience);
  if (!opened) return opened.error();
  History& history = opened.value();
  check_integrity(history);
  Statement query(history, R"sql(
    SELECT at, plan, name, verdict, unit, seed, measured, margin, inputs FROM (
      SELECT run.at, run.id, plan, name, e.verdict, unit, seed, measured, margin, inputs,
             row_number() OVER (PARTITION BY plan, name ORDER BY run.id DESC) AS age
      FROM expectation e JOIN run ON run.id = e.run
      WHERE (?1 = '' OR plan = ?1) AND (?2 = '' OR instr(name, ?2) > 0))
    WHERE age <= ?3 ORDER BY plan, name, id)sql");
  query.bind(plan).bind(expectation).bind(static_cast<sqlite3_int64>(runs));
  std::vector<PastExpectation> rows;
  while (query.next()) {
    rows.push_back({query.text(0), query.text(1), query.text(2), query.text(3), query.text(4),
                    query.text(5), query.real(6), query.real(7), query.text(8)});
  }
  if (rows.empty() && !expectation.empty()) {
    return Error{ErrorKind::bad_input, file,
                 "holds no expectation with '" + expectation + "' in its name",
                 "whirl history PLAN shows what it holds"};
  }
  if (rows.empty() && !plan.empty()) {  // a run that was interrupted at once is one without any
    Statement run(history, "SELECT 1 FROM run WHERE plan = ?1");
    run.bind(plan);
    if (!run.next() && history.good()) {
      return Error{ErrorKind::bad_input, file, "holds no run of '" + plan + "'",
                   "whirl history without a name shows all plans"};
    }
  }
  if (!history.good()) return history.error();
  return rows;
}

}  // namespace whirl::results
