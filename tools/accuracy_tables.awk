# awk -f accuracy_tables.awk ROWS accuracy.md: the document with its tables rewritten.
#   ROWS: section <tab> name <tab> measured <tab> bound <tab> unit, in any order, repeats allowed
#   table: between the lines "<!-- rows: SECTION -->" and "<!-- end -->", one row a line
# Sorted by name, so that the same rows give the same bytes. Sections without a table are appended.

function key(section, name) { return section SUBSEP name }

function print_table(section,    i, j, n, names, swap) {
  n = 0
  for (k in text) {
    split(k, part, SUBSEP)
    if (part[1] == section) names[++n] = part[2]
  }
  for (i = 2; i <= n; i++)
    for (j = i; j > 1 && names[j] < names[j - 1]; j--) {
      swap = names[j]; names[j] = names[j - 1]; names[j - 1] = swap
    }
  print "<!-- rows: " section " -->"
  print "| what | measured | bound | unit |"
  print "|---|---|---|---|"
  for (i = 1; i <= n; i++) print text[key(section, names[i])]
  print "<!-- end -->"
}

FNR == NR {
  if (split($0, f, "\t") != 5) { print "bad row: " $0 > "/dev/stderr"; failed = 1; exit 1 }
  k = key(f[1], f[2])
  if (!(k in fresh) || f[3] + 0 > fresh[k]) {
    fresh[k] = f[3] + 0
    text[k] = "| " f[2] " | " f[3] " | " f[4] " | " f[5] " |"
  }
  next
}

/^<!-- rows: .* -->$/ {
  section = $0
  sub(/^<!-- rows: /, "", section); sub(/ -->$/, "", section)
  known[section] = 1
  next
}
/^<!-- end -->$/ && section != "" { print_table(section); section = ""; next }
section != "" {
  if (split($0, f, / *\| */) >= 6 && f[2] != "what" && $0 !~ /^\|-/ && !(key(section, f[2]) in text))
    text[key(section, f[2])] = $0
  next
}
{ print }

END {
  if (failed) exit 1
  if (section != "") { print "table without its end: " section > "/dev/stderr"; exit 1 }
  m = 0
  for (k in fresh) {
    split(k, part, SUBSEP)
    if (!(part[1] in known)) { known[part[1]] = 1; added[++m] = part[1] }
  }
  for (i = 2; i <= m; i++)
    for (j = i; j > 1 && added[j] < added[j - 1]; j--) {
      swap = added[j]; added[j] = added[j - 1]; added[j - 1] = swap
    }
  for (i = 1; i <= m; i++) { print ""; print "## " added[i]; print ""; print_table(added[i]) }
}
