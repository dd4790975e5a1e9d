"""Tables in Markdown, and a document's parts between <!-- NAME --> and <!-- end -->, for the scripts beside this
one."""
import csv
import os
import re
import sys


def read(path):
    with open(path, newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


def read_if_there(path, columns=()):
    """The rows so far of a table that grows run by run, which has these columns at least. A last line that was cut
    short would be taken for a run."""
    if not os.path.exists(path):
        return []
    with open(path, encoding="utf-8") as stream:
        text = stream.read()
    if text and not text.endswith("\n"):
        sys.exit(f"{path}: the last line has no end; delete it, and its run is done again")
    rows = read(path)
    for number, row in enumerate(rows, 1):
        missing = [name for name in columns if name not in row]
        if missing:
            sys.exit(f"{path}: the head has no column {missing[0]}; put it right")
        if None in row or None in row.values():
            sys.exit(f"{path}: row {number} has not as many values as the head; delete it, and its run is done again")
    return rows


def add_row(path, columns, row):
    """At the end of a CSV file, with the head of a new or empty one."""
    new = not os.path.exists(path) or os.path.getsize(path) == 0
    with open(path, "a", newline="", encoding="utf-8") as stream:
        writer = csv.DictWriter(stream, columns, lineterminator="\n")
        if new:
            writer.writeheader()
        writer.writerow(row)


def markdown(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|---" * len(head) + "|"]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def fill(document, parts):
    """Replaces what stands between the marks; each part must have its mark."""
    with open(document, encoding="utf-8") as stream:
        text = stream.read()
    for name, part in parts.items():
        pattern = re.compile(rf"(<!-- {name} -->\n).*?(<!-- end -->)", re.DOTALL)
        if not pattern.search(text):
            sys.exit(f"{document} has no mark <!-- {name} -->")
        text = pattern.sub(lambda found, part=part: found[1] + part + "\n" + found[2], text)
    with open(document, "w", encoding="utf-8") as stream:
        stream.write(text)
    print(f"tables: {document}")


def main():
    """docs/tables.py DOCUMENT NAME=FILE...: what FILE holds between the marks of NAME."""
    parts = {}
    for argument in sys.argv[2:]:
        name, path = argument.split("=", 1)
        with open(path, encoding="utf-8") as stream:
            parts[name] = stream.read().strip()
    fill(sys.argv[1], parts)


if __name__ == "__main__":
    main()
