"""What the site adds to the pages: citations that lead to a list of references, pictures that open."""

import re
from pathlib import Path

from mkdocs.structure.files import File
from pybtex.backends.markdown import Backend
from pybtex.database import parse_file
from pybtex.style.formatting.plain import Style

PAGE = "docs/references.md"
_keys = []


def _entry(formatted):
    text = re.sub(r"\\\\url (\S+?),", lambda url: "<" + url[1].replace("\\", "") + ">,", formatted.text.render(Backend()))
    return f'<a id="{formatted.key}"></a>`{formatted.key}`\n:   {text}\n'


def on_files(files, config):
    """Adds the page of references, made of docs/references.bib."""
    bibliography = parse_file(str(Path(config.docs_dir) / "docs/references.bib"))
    _keys[:] = sorted(bibliography.entries)
    style = Style(sorting_style="author_year_title")
    entries = [_entry(entry) for entry in style.format_entries(bibliography.entries.values())]
    page = Path(config.docs_dir) / PAGE
    page.write_text("# References\n\nThe entries of [references.bib](references.bib).\n\n"
                    + "\n".join(entries), encoding="utf-8")
    files.append(File(PAGE, config.docs_dir, config.site_dir, config.use_directory_urls))
    return files


def _link_sources(markdown, keys):
    """In the last column of a table a bare key is a citation."""
    last = re.compile(r"\| ([^|]*) \|$", re.M)
    known = re.compile(r"\b(" + "|".join(map(re.escape, keys)) + r")\b")
    return last.sub(lambda cell: "| " + known.sub(r"[\1]", cell[1]) + " |", markdown)


def on_page_markdown(markdown, page, config, files):
    """Makes [key] a link, by the definitions that Markdown wants at the end of a page."""
    source = page.file.src_uri
    if source == PAGE:
        return markdown
    if source == "docs/parameters.md":
        markdown = _link_sources(markdown, _keys)
    cited = [key for key in _keys if f"[{key}]" in markdown]
    references = "../" * source.count("/") + PAGE
    return markdown + "\n\n" + "\n".join(f"[{key}]: {references}#{key}" for key in cited)


def on_page_content(html, page, config, files):
    """Lets a click on a picture open it in its full size."""
    return re.sub(r'<img ([^>]*?)src="([^"]+)"([^>]*)>', r'<a href="\2"><img \1src="\2"\3></a>', html)
