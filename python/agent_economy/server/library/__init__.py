"""The lists of the page as a library: titles, notes, tags, sizes, copies, and deletion with undo.

Ids stay what they are: the path of a file or folder below the server's folder. What a user calls an
entry is its title, in a label beside it, so that links, hashes and resumed studies do not change.
`kinds` has the kinds of entries, `label` the title, note and tags of one, `trash` what was deleted;
`library` does what pages request, and `routes` has the addresses.
"""
