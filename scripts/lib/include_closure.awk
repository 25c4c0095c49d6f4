# Input: three parts with a line "--" between them. The first is `sha256sum` of every source file, the second is `grep`
# of their quoted include lines, the third lists files. Output: each listed file with the hashes of itself and of all
# files that it includes.
function resolve(from, name,    folder, i, candidate) {
    folder = from
    sub(/[^\/]*$/, "", folder)
    split("src/ tests/", roots, " ")
    if ((folder name) in hash) return folder name
    for (i = 1; i <= 2; ++i) {
        candidate = roots[i] name
        if (candidate in hash) return candidate
    }
    return ""
}

# Marks `file` and all files that it includes, directly or not, in the array `seen`. Appends their hashes to `material`.
function visit(file,    n, list, i) {
    if (file in seen) return
    seen[file] = 1
    material = material " " hash[file]
    n = split(includes[file], list, " ")
    for (i = 1; i <= n; ++i) visit(list[i])
}

$0 == "--" { ++part; next }
part == 0 { hash[$2] = $1 }
part == 1 {
    colon = index($0, ":")
    from = substr($0, 1, colon - 1)
    split($0, quoted, "\"")
    target = resolve(from, quoted[2])
    if (target != "") includes[from] = includes[from] " " target
}
part == 2 {
    split("", seen)
    material = ""
    visit($1)
    print $1 material
}
