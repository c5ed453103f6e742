"""The table of a bench: printed row by row, and written into a page of the docs below a comment."""

import argparse
from pathlib import Path


def main(about, mark, table):
    """Print the rows of `table`, and with --docs PAGE write them into the page below the comment `mark`."""
    parser = argparse.ArgumentParser(description=about, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--docs", metavar="PAGE", help="write the table into a page, below the comment")
    args = parser.parse_args()
    rows = []
    for row in table():
        rows.append("| " + " | ".join(row) + " |")
        print(rows[-1], flush=True)
    if args.docs:
        page = Path(args.docs)
        before, after = page.read_text(encoding="utf-8").split(mark)
        page.write_text(before + mark + "\n".join(rows) + after[after.index("\n\n") :], encoding="utf-8")
