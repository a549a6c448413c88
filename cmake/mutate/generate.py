"""Writes a mutated copy of one source: every mutant in it, chosen by number when it runs.

    generate.py --root ROOT --source PATH --out FILE --first NUMBER -- CLANG_FLAGS...

  Mutants  comparisons (boundary, direction), arithmetic signs, && and ||, conditions negated,
           constants one more and one less, statements dropped, returned numbers and flags replaced
  Not in   macros and their arguments, templates, constexpr, static_assert, case labels, array bounds,
           default arguments, and anything outside of a function's body
  List     FILE.mutants: number, file:line, what is changed, the line, one mutant per line
"""
import argparse
import sys

from clang.cindex import CursorKind as K, Index, TranslationUnit, TypeKind as T

RELATIONS = {"<": ("less", "<=", ">"), "<=": ("less_or_equal", "<", ">="),
             ">": ("more", ">=", "<"), ">=": ("more_or_equal", ">", "<=")}
EQUALITIES = {"==": ("equal", "!="), "!=": ("unequal", "==")}
ARITHMETIC = {"+": ("plus", "-"), "-": ("minus", "+"), "*": ("times", "/"), "/": ("over", "*"),
              "%": ("rest", "*")}
LOGIC = {"&&": ("both", "||"), "||": ("either", "&&")}
NUMBERS = {T.BOOL, T.CHAR_S, T.SCHAR, T.UCHAR, T.USHORT, T.SHORT, T.INT, T.UINT, T.LONG, T.ULONG,
           T.LONGLONG, T.ULONGLONG, T.FLOAT, T.DOUBLE, T.ENUM}
FUNCTIONS = {K.FUNCTION_DECL, K.CXX_METHOD, K.CONSTRUCTOR, K.DESTRUCTOR, K.CONVERSION_FUNCTION}


class Mutator:
    def __init__(self, unit, source, text, first):
        self.source, self.text = source, text
        self.next, self.first = first, first
        self.mutants = []           # number, line, what
        self.insertions = []        # offset, order, text
        self.replacements = []      # from, to, text
        self.macros = [(c.extent.start.offset, c.extent.end.offset)
                       for c in unit.cursor.get_children()
                       if c.kind == K.MACRO_INSTANTIATION and self.here(c)]
        self.unit = unit

    def here(self, cursor):
        file = cursor.extent.start.file
        return file is not None and file.name == self.source

    def in_macro(self, start, end):
        return any(start < b and a < end for a, b in self.macros)

    def number(self, cursor, *changes):
        first = self.next
        for change in changes:
            self.mutants.append((self.next, cursor.extent.start.line, change))
            self.next += 1
        return first

    def wrap(self, start, end, before, after):
        size = end - start
        self.insertions.append((start, 1, -size, before))   # outer first
        self.insertions.append((end, 0, size, after))       # inner first

    def operator_of(self, left, right):
        a, b = left.extent.end.offset, right.extent.start.offset
        between = self.text[a:b]
        # Comments between operands are rare and would hide the operator: leave them alone.
        spelling = between.strip()
        return (spelling, a, b) if spelling and "/*" not in spelling and "//" not in spelling else (None, a, b)

    # The walk: `inside` is a function's body.
    def visit(self, cursor, inside):
        kind = cursor.kind
        if kind in (K.FUNCTION_TEMPLATE, K.CLASS_TEMPLATE, K.CLASS_TEMPLATE_PARTIAL_SPECIALIZATION,
                    K.STATIC_ASSERT, K.PARM_DECL, K.ENUM_DECL):
            return
        if kind in FUNCTIONS | {K.VAR_DECL} and self.is_constexpr(cursor):
            return
        start, end = cursor.extent.start.offset, cursor.extent.end.offset
        if kind == K.DECL_STMT and "constexpr" in self.text[start:end].split("=")[0].split():
            return  # of all that it declares
        if inside and self.in_macro(start, end) and not any(a > start and b < end for a, b in self.macros):
            return  # it is (in) a macro; one that only contains a macro is walked
        children = list(cursor.get_children())
        if inside:
            self.mutate(cursor, children)
        for i, child in enumerate(children):
            if kind == K.CASE_STMT and i == 0:
                continue
            if kind in (K.VAR_DECL, K.FIELD_DECL) and child.kind == K.INTEGER_LITERAL and (
                    cursor.type.kind == T.CONSTANTARRAY or
                    any(c.kind == K.TEMPLATE_REF for c in children)):
                continue
            self.visit(child, inside or (kind in FUNCTIONS | {K.LAMBDA_EXPR} and child.kind == K.COMPOUND_STMT))

    def is_constexpr(self, cursor):
        for token in cursor.get_tokens():
            if token.spelling in ("constexpr", "consteval"):
                return True
            if token.spelling in ("{", "=", "(", ";"):
                return False
        return False

    # Whole words of the source, of which a macro is either all or nothing.
    def clean(self, start, end):
        # (A rewritten a != b of C++20 is shown as a negation that begins at its operator.)
        return start < end and self.text[start:start + 2] != "!=" and all(
            not a < start < b and not a < end < b and (start != a or end >= b) for a, b in self.macros)

    def followed_by(self, end, words):
        return self.text[end:].lstrip().startswith(words)

    def mutate(self, cursor, children):
        kind = cursor.kind
        start, end = cursor.extent.start.offset, cursor.extent.end.offset
        if kind == K.BINARY_OPERATOR and len(children) == 2:
            self.binary(cursor, children, start, end)
        elif kind == K.COMPOUND_ASSIGNMENT_OPERATOR and len(children) == 2:
            operator, _, b = self.operator_of(*children)
            if operator in ("+=", "-=") and children[1].type.get_canonical().kind in NUMBERS:
                i = self.number(cursor, operator + " -> " + ("-=" if operator == "+=" else "+="))
                self.wrap(b, children[1].extent.end.offset, f"mutate::opposite({i}, ", ")")
        elif kind in (K.INTEGER_LITERAL, K.FLOATING_LITERAL) and not self.in_macro(start, end + 1) and (
                self.text[start].isdigit()):
            word = self.text[start:end]
            more = "1" if kind == K.INTEGER_LITERAL else "1 %"
            i = self.number(cursor, f"{word} -> {word} + {more}", f"{word} -> {word} - 1")
            self.wrap(start, end, f"mutate::constant({i}, ", ")")
        elif kind == K.UNARY_OPERATOR and self.text[start] == "!" and self.clean(start, end):
            i = self.number(cursor, "! dropped")
            self.wrap(start, end, f"mutate::truth({i}, ", ")")
        elif kind == K.RETURN_STMT and children:
            self.returned(cursor, children[0])
        elif kind in (K.IF_STMT, K.WHILE_STMT, K.CONDITIONAL_OPERATOR):
            self.condition(cursor, children)
        if kind == K.COMPOUND_STMT:
            for child in children:
                self.drop(child)
        elif kind in (K.IF_STMT, K.WHILE_STMT, K.FOR_STMT, K.CXX_FOR_RANGE_STMT) and children:
            body = children[1 if kind == K.IF_STMT else -1] if len(children) > 1 else None
            if body is not None and kind != K.IF_STMT and body.kind != K.COMPOUND_STMT:
                self.drop(body)
            if kind == K.IF_STMT:
                bodies = [c for c in children if c.kind not in (K.COMPOUND_STMT, K.DECL_STMT, K.VAR_DECL)]
                for child in bodies[1:]:
                    if len(children) < 3 or child.kind.is_expression():
                        self.drop(child)

    def binary(self, cursor, children, start, end):
        left, right = children
        operator, a, b = self.operator_of(left, right)
        if operator is None or a >= b or self.in_macro(a, b) or not self.clean(start, end):
            return
        if (start, end) != (left.extent.start.offset, right.extent.end.offset):
            return
        kinds = {c.type.get_canonical().kind for c in children}
        numbers = kinds <= NUMBERS
        if operator in RELATIONS and numbers:
            name, boundary, flipped = RELATIONS[operator]
            i = self.number(cursor, f"{operator} -> {boundary}", f"{operator} -> {flipped}")
        elif operator in EQUALITIES:
            name, other = EQUALITIES[operator]
            i = self.number(cursor, f"{operator} -> {other}")
        elif operator in ARITHMETIC and numbers:
            name, other = ARITHMETIC[operator]
            i = self.number(cursor, f"{operator} -> {other}")
        elif operator in LOGIC:
            name, other = LOGIC[operator]
            i = self.number(cursor, f"{operator} -> {other}")
            self.wrap(start, end, f"mutate::{name}({i}, bool(", "); })")
            self.replacements.append((a, b, "), [&] { return bool("))
            return
        else:
            return
        self.wrap(start, end, f"mutate::{name}({i}, ", ")")
        self.replacements.append((a, b, ", "))

    def returned(self, statement, value):
        start, end = value.extent.start.offset, value.extent.end.offset
        kind = value.type.get_canonical().kind
        if kind not in NUMBERS - {T.ENUM} or not self.clean(start, end) or not self.followed_by(end, ";"):
            return
        if kind == T.BOOL and self.is_comparison(value):
            return  # its own mutants negate it already
        i = self.number(statement, "return " + ("negated" if kind == T.BOOL else "0"))
        self.wrap(start, end, f"mutate::result({i}, ", ")")

    def is_comparison(self, cursor):
        while cursor.kind in (K.UNEXPOSED_EXPR, K.PAREN_EXPR):
            inner = list(cursor.get_children())
            if len(inner) != 1:
                return False
            cursor = inner[0]
        return cursor.kind == K.BINARY_OPERATOR or (
            cursor.kind == K.UNARY_OPERATOR and self.text[cursor.extent.start.offset] == "!")

    def condition(self, cursor, children):
        expressions = [c for c in children if c.kind.is_expression()]
        if not expressions:
            return
        first = expressions[0]
        if any(c.kind in (K.DECL_STMT, K.VAR_DECL) for c in children[:1]) and cursor.kind == K.IF_STMT:
            # if (init; condition): the condition is the first expression all the same; a declaration
            # as the condition itself has no expression before its body.
            header_end = children[children.index(first) - 1].extent.end.offset
            if ";" not in self.text[header_end - 1:first.extent.start.offset]:
                return
        start, end = first.extent.start.offset, first.extent.end.offset
        closing = "?" if cursor.kind == K.CONDITIONAL_OPERATOR else ")"
        if not self.clean(start, end) or not self.followed_by(end, closing) or self.is_comparison(first):
            return
        if cursor.kind == K.IF_STMT and "if constexpr" in self.text[cursor.extent.start.offset:start]:
            return
        i = self.number(cursor, "condition negated")
        self.wrap(start, end, f"mutate::truth({i}, bool(", "))")

    def drop(self, statement):
        start, end = statement.extent.start.offset, statement.extent.end.offset
        if not self.clean(start, end) or not self.followed_by(end, ";"):
            return
        if statement.kind in (K.CONTINUE_STMT, K.BREAK_STMT):
            i = self.number(statement, "statement dropped")
            self.wrap(start, end, f"if (mutate::off({i})) ", "")
        elif statement.kind == K.RETURN_STMT and not list(statement.get_children()):
            i = self.number(statement, "statement dropped")
            self.wrap(start, end, f"if (mutate::off({i})) ", "")
        elif statement.kind.is_expression():
            i = self.number(statement, "statement dropped")
            self.wrap(start, end, f"mutate::off({i}) ? void(", ") : void()")

    def mutated_text(self):
        data = self.text
        edits = [(at, order, size, "", at, words) for at, order, size, words in self.insertions]
        edits += [(a, 0.5, 0, "", b, words) for a, b, words in self.replacements]
        edits.sort(key=lambda e: (e[0], e[1], e[2]))
        out, at = [], 0
        for start, _, _, _, end, words in edits:
            out.append(data[at:start] if start > at else "")
            out.append(words)
            at = max(at, end)
        out.append(data[at:])
        return "".join(out)


def main():
    parser = argparse.ArgumentParser()
    for name in ("--root", "--source", "--out"):
        parser.add_argument(name, required=True)
    parser.add_argument("--first", type=int, required=True)
    parser.add_argument("flags", nargs="*")
    options = parser.parse_args()
    path = f"{options.root}/{options.source}"
    with open(path, encoding="ascii") as file:
        text = file.read()
    unit = Index.create().parse(path, args=["-x", "c++", "-std=c++20", *options.flags],
                                options=TranslationUnit.PARSE_DETAILED_PROCESSING_RECORD)
    errors = [d for d in unit.diagnostics if d.severity >= 3]
    if errors:
        sys.exit(f"{options.source}: {errors[0].spelling} ({errors[0].location})")
    mutator = Mutator(unit, path, text, options.first)
    for cursor in unit.cursor.get_children():
        if mutator.here(cursor):
            mutator.visit(cursor, False)
    if not mutator.mutants:
        sys.exit(f"{options.source}: no mutant found")
    lines = text.split("\n")
    with open(options.out, "w", encoding="ascii") as out:
        out.write('#include "cmake/mutate/mutate.hpp"\n' + mutator.mutated_text())
    with open(options.out + ".mutants", "w", encoding="ascii") as out:
        for number, line, what in mutator.mutants:
            out.write(f"{number}\t{options.source}:{line}\t{what}\t{lines[line - 1].strip()}\n")


main()
