# Shows doxygen the comments of a header as documentation, line by line:
#
#   the comment that starts the file     -> /** \file */; the #pragma once after it is dropped to keep line numbers
#   // lines right before a declaration  -> /** */
#   declaration;  // text                -> ///<
#
# A comment before an empty line, or inside a function, belongs to no declaration and stays a plain comment. Indented
# lines are shown verbatim. Markup of doxygen or Markdown is escaped, except `code` and lists.

# Kind of the current scope: declarations (D), enumerators (E), or a body or an initializer (B).
function scope() { return depth == 0 ? "D" : kind[depth] }
function declares() { return scope() != "B" && parens == 0 && (head == "" || scope() == "E" && head !~ /=[^,]*$/) }

# Kind of the scope that the brace after this start of a declaration opens.
function opens(text) {
  while (gsub(/<[^<>]*>/, "", text)) {}
  gsub(/(public|private|protected) *:|alignas\([^)]*\)|template|inline/, "", text)
  gsub(/^ +/, "", text)
  if (text ~ /^enum /) return "E"
  return text ~ /^(namespace|struct|class|union)( |$)/ && text !~ /[(=]/ ? "D" : "B"
}

# Follows scopes through the code of a line; returns the column of its // or 0.
function follow(line,    i, c, quote, column) {
  for (i = 1; i <= length(line); ++i) {
    c = substr(line, i, 1)
    if (quote != "") {
      if (c == "\\") ++i
      else if (c == quote) quote = ""
      continue
    }
    if (c == "/" && substr(line, i, 2) == "//") { column = i; break }
    if (c == "\"" || c == "'" && substr(line, i - 1, 1) !~ /[0-9]/) quote = c
    else if (c == "(") ++parens
    else if (c == ")") --parens
    if (c == "{") { kind[depth + 1] = opens(head); outer[depth + 1] = parens; ++depth; parens = 0; head = "" }
    else if (c == "}") {
      parens = outer[depth]
      head = ""
      --depth
    } else if (c == ";" && parens == 0 || c == "," && parens == 0 && scope() == "E") head = ""
    else if (c != " " || head != "") head = head c
  }
  if (head ~ /^(public|private|protected):$/ || head ~ /^#/) head = ""
  return column + 0
}

function escaped(text,    i, c, result, code) {
  gsub(/t\.u\. /, "t.u.\\ ", text)  # ends no sentence
  for (i = 1; i <= length(text); ++i) {
    c = substr(text, i, 1)
    if (c == "`") code = !code
    else if (code || substr(text, i, 2) == "\\ ") {}
    else if (c ~ /[\\@<>#&$%*\[\]]/ ||
             c == ":" && substr(text, i, 2) == "::" && substr(text, i - 1, 1) !~ /[A-Za-z0-9_:]/ ||
             c == "_" && (substr(text, i - 1, 1) !~ /[A-Za-z0-9]/ || substr(text, i + 1, 1) !~ /[A-Za-z0-9]/))
      c = "\\" c
    result = result c
  }
  return result
}

# Prints the pending comment lines, as documentation or unchanged.
function flush_comment(documents,    i, text, shown, listed, lines) {
  for (i = 1; i <= waiting; ++i) {
    text = lines[i] = comment[i]
    if (!documents) continue
    sub(/^ *\/\/ ?/, "", text)
    if (text ~ /^  / && !listed) {
      lines[i] = text
      if (i == 1) lines[1] = "\\verbatim " text
      else if (!shown) lines[i - 1] = lines[i - 1] " \\verbatim"
      shown = 1
    } else {
      listed = text ~ /^- / || listed && text ~ /^  /
      lines[i] = (shown ? "\\endverbatim " : "") escaped(text)
      shown = 0
    }
  }
  if (documents && waiting) {
    lines[1] = "/** " (in_file ? "\\file\n" : "") lines[1]
    lines[waiting] = lines[waiting] (shown ? " \\endverbatim */" : " */")
  }
  for (i = 1; i <= waiting; ++i) print lines[i]
  waiting = 0
}

FNR == 1 && /^\/\// { in_file = 1 }
in_file && /^#pragma once/ { flush_comment(1); in_file = 0; next }

/^ *\/\// && (in_file || declares()) { comment[++waiting] = $0; next }

{
  flush_comment($0 !~ /^ *($|[}#]|static_assert|public:|private:|protected:|template class|extern )/)
  column = follow($0)
  code = column ? substr($0, 1, column - 1) : $0
  if (column && declares() && code ~ /[;,}a-z0-9] *$/ && code !~ /^[ };]*$/)
    print code "///< " escaped(substr($0, column + 3))
  else
    print
}
END { flush_comment(0) }
