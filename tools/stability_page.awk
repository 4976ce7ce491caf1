# awk -f stability_page.awk rows.table kind=beside BESIDE kind=live ROWS kind=naive ROWS
#     kind=page stability.md: the page with its tables written again.
#   rows.table: tests/stability/rows.table, which says what the rows are
#   beside: row <tab> measured <tab> criterion <tab> naive <tab> unit (expect_stable.h)
#   live, naive: rows of accuracy_report.h, of the tests and of their mutants
# Numbers that this run did not measure stay as the page has them. A live row without
# numbers is an error, and so is one whose measured value is above its bound or whose naive one is not.

# The larger of two numbers as text; inf and nan are larger than any.
function larger(a, b) {
  if (a == "") return b
  if (a ~ /nan|inf/) return a
  if (b ~ /nan|inf/) return b
  return a + 0 >= b + 0 ? a : b
}
function fail(why) {
  print "stability_page: " why > "/dev/stderr"
  failed = 1
}
function cell(row, key) { return text[row, key] }

FNR == 1 && kind == "" { kind = "table" }

kind == "table" && /^[a-z]/ {
  key = $1
  rest = substr($0, length(key) + 2)
  if (key == "row") { row = $2; order[++rows] = row; slug[row] = $3 }
  else text[row, key] = rest
  next
}
kind == "table" { next }

kind != "page" { split($0, f, "\t") }
kind == "beside" {
  measured[f[1]] = larger(measured[f[1]], f[2])
  bound[f[1]] = f[3]
  naive[f[1]] = larger(naive[f[1]], f[4])
  next
}
kind == "live" {
  of_live[f[1] ": " f[2]] = larger(of_live[f[1] ": " f[2]], f[3])
  bound_live[f[1] ": " f[2]] = f[4]
  next
}
kind == "naive" { of_naive[f[1], f[2] ": " f[3]] = larger(of_naive[f[1], f[2] ": " f[3]], f[4]); next }

# The page.
/^<!-- rows: .* -->$/ { section = $3; print; next }
section != "" && /^<!-- end -->$/ {
  if (section == "live") print_live()
  else print_later()
  section = ""
  print
  next
}
section != "" {
  n = split($0, f, / *\| */)
  if (section == "live" && n >= 9) {
    old_measured[f[2]] = f[6]
    old_bound[f[2]] = f[7]
    old_naive[f[2]] = f[9]
  }
  next
}
{ print }

function print_live(   i, r, m, b, v) {
  print "| row | case | stable form | criterion | measured | bound | naive form | measures |"
  print "|---|---|---|---|---|---|---|---|"
  for (i = 1; i <= rows; i++) {
    r = order[i]
    if (!((r, "shown") in text)) continue
    m = measured[r]
    b = bound[r]
    v = naive[r]
    if ((r, "measured") in text) {
      b = bound_live[text[r, "measured"]]
      m = of_live[text[r, "measured"]]
      v = of_naive[text[r, "mutant"], text[r, "measured"]]
    }
    if (m == "") m = old_measured[r]
    if (b == "") b = old_bound[r]
    if (v == "") v = old_naive[r]
    if (m == "" || b == "" || v == "")
      fail("row " r " lacks numbers" (check ? ": run tools/update_stability.sh" : ""))
    else if (m ~ /nan|inf/ || m + 0 > b + 0) fail("row " r ": " m " is above its bound " b)
    else if (v !~ /nan|inf/ && v + 0 <= b + 0) fail("row " r ": the naive form holds too: " v)
    print "| " r " | " cell(r, "case") " | " cell(r, "stable") " | " cell(r, "criterion") " | " m \
      " | " b " | " cell(r, "naive") " | " v " |"
  }
}
function print_later(   i, r) {
  print "| row | case | stable form | criterion | naive form | waits for |"
  print "|---|---|---|---|---|---|"
  for (i = 1; i <= rows; i++) {
    r = order[i]
    if ((r, "later") in text)
      print "| " r " | " cell(r, "case") " | " cell(r, "stable") " | " cell(r, "criterion") " | " \
        cell(r, "naive") " | " cell(r, "later") " |"
  }
}
END { if (failed) exit 1 }
