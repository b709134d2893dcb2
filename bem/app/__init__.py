"""A local web page over scenes and runs: choose, see the plan, run, look, compare.

It knows nothing that the command line does not. `workspace` is the folder that it shows, in which everything lies that
must not be lost; `scene_file` makes changes to scenes there; `worker` is the process of its own that a run is;
`computing` are the processes in which plans (`planning`), surfaces (`treatment`) and what is shown of runs
(`run_view`, with `pictures` and `solids`) are computed; `server` and the `*_page` files show them with NiceGUI, chosen
because its pages are Python on the server (a page is a view of files, so a reload loses nothing), and because all it
needs in the browser is in its package: no network. Only these files load it, and only `bem app` loads them.

Sees runs, plots and scenes; only the command line sees it. Verified in tests/app.
"""
