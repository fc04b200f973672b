# Gives doxygen the links of the READMEs: headings get labels of folder and title, links to headings go to these.
# Of a link to a file that is no page the text is left. -v root= the project's folder.

function label(folder, title) {
  sub(/README\.md$/, "", folder)
  sub(/\.md$/, "-", folder)
  gsub(/\//, "-", folder)
  title = tolower(title)
  gsub(/[^a-z0-9 _-]/, "", title)
  gsub(/ /, "-", title)
  return "readme-" folder title
}

# A path beside the page, from the project's folder.
function resolved(path,    folder) {
  folder = page
  sub(/[^\/]*$/, "", folder)
  while (path ~ /^\.\.\//) {
    path = substr(path, 4)
    sub(/[^\/]+\/$/, "", folder)
  }
  return folder path
}

function target(link,    at) {
  if (link ~ /:\/\/|\.md$/) return link
  if (link ~ /\.(png|svg)$/) return resolved(link)
  at = index(link, "#")
  if (at == 0) return ""
  return "@ref " label(at == 1 ? page : resolved(substr(link, 1, at - 1)), substr(link, at + 1))
}

FNR == 1 { page = index(FILENAME, root "/") == 1 ? substr(FILENAME, length(root) + 2) : FILENAME }

/^##+ / {
  title = $0
  sub(/^#+ +/, "", title)
  $0 = $0 " {#" label(page, title) "}"
}

!/^    / {
  done = ""
  while (match($0, /\]\([^) ]+\)/)) {
    link = target(substr($0, RSTART + 2, RLENGTH - 3))
    before = substr($0, 1, RSTART - 1)
    if (link == "") {
      sub(/\[[^[]*$/, "", before)
      text = substr($0, length(before) + 2, RSTART - length(before) - 2)
    } else
      text = "](" link ")"
    done = done before text
    $0 = substr($0, RSTART + RLENGTH)
  }
  $0 = done $0
}
{ print }
