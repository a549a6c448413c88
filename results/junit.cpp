// junit.xml: one suite per run, one case per expectation, one more for how the run itself ended.
//
//   Dialect  the common subset: every case has name and classname (unique together), at most one
//            failure or error child, its message repeated in the text (some viewers show only that)
#include <cmath>
#include <cstdio>
#include <pugixml.hpp>
#include <sstream>

#include "base/text.hpp"
#include "results/folder.hpp"

namespace whirl::results {
namespace {

std::string decimal(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.6f", x);
  return text;
}

std::string short_number(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.6g", x);
  return text;
}

std::string sentence(const Expectation& e) {
  const std::string unit = e.unit.empty() ? "" : " " + e.unit;
  std::string text = "measured " + short_number(e.measured) + unit + ", wanted " + e.limit_text();
  if (!e.note.empty()) text += "; " + e.note;
  return text;
}

pugi::xml_node add_case(pugi::xml_node suite, const std::string& plan, const std::string& name) {
  auto node = suite.append_child("testcase");
  node.append_attribute("classname") = legal_text(plan).c_str();
  node.append_attribute("name") = legal_text(name).c_str();
  node.append_attribute("time") = "0";
  return node;
}

void add_complaint(pugi::xml_node node, const char* kind, const std::string& type,
                   const std::string& message) {
  auto child = node.append_child(kind);
  child.append_attribute("message") = legal_text(message).c_str();
  child.append_attribute("type") = legal_text(type).c_str();
  child.text() = legal_text(message).c_str();
}

void add_suite(pugi::xml_node root, const Report& r) {
  auto suite = root.append_child("testsuite");
  std::size_t failures = 0, skipped = 0;
  for (const Expectation& e : r.expectations) {
    auto node = add_case(suite, r.plan, e.name);
    if (!e.place.empty()) node.append_attribute("file") = legal_text(e.place).c_str();
    if (e.verdict == Verdict::pass) {
      node.append_child("system-out").text() = legal_text(sentence(e)).c_str();
    } else if (!r.judged) {
      ++skipped;
      node.append_child("skipped").append_attribute("message") = legal_text(sentence(e)).c_str();
    } else {
      ++failures;
      add_complaint(node, "failure", e.how.empty() ? "expectation" : e.how, sentence(e));
    }
  }
  auto whole = add_case(suite, r.plan, "the run ends in order");
  whole.attribute("time") = decimal(r.host.total_s).c_str();
  std::string out = "seed " + std::to_string(r.seed) + ", digest " + r.digest + ", " +
                    short_number(r.virtual_s) + " s virtual";
  for (const CpuFaultRow& f : r.cpu_faults)
    out += "\n" + f.name + " in " + f.where + "\n" + f.backtrace + "\n" + f.registers;
  std::size_t errors = 0;
  if (r.verdict == Verdict::error || r.verdict == Verdict::inconclusive) {
    ++errors;
    add_complaint(whole, "error", name(r.verdict), r.reason);
  }
  whole.append_child("system-out").text() = legal_text(out).c_str();
  suite.append_attribute("name") = legal_text(r.plan).c_str();
  suite.append_attribute("tests") = static_cast<unsigned>(r.expectations.size() + 1);
  suite.append_attribute("failures") = static_cast<unsigned>(failures);
  suite.append_attribute("errors") = static_cast<unsigned>(errors);
  suite.append_attribute("skipped") = static_cast<unsigned>(skipped);
  suite.append_attribute("time") = decimal(r.host.total_s).c_str();
}

}  // namespace

std::string junit_xml(const std::vector<const Report*>& reports) {
  pugi::xml_document document;
  auto declaration = document.append_child(pugi::node_declaration);
  declaration.append_attribute("version") = "1.0";
  declaration.append_attribute("encoding") = "UTF-8";
  auto root = document.append_child("testsuites");
  for (const Report* report : reports) add_suite(root, *report);
  std::ostringstream out;
  document.save(out, "  ", pugi::format_default, pugi::encoding_utf8);
  return out.str();
}

}  // namespace whirl::results
