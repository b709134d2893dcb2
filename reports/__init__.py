"""Reports for people who have to sign: verification, performance, validation; one builder, one look, one index.

`python -m reports` builds all into `reports/`; `python -m reports verification` one. Each report is a module with a
function `build() -> Page`; pages are written by `builder.write_site`.
"""
