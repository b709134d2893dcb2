from bem import open_run, run_scene

run = run_scene("sinusoid", "out", settings=["grid.shape=[32, 4]", "grid.spacing=3.2 um"], figures=False)
run.summary["contact_area_fraction"]  # the same as in out/summary.json
run.dataset["pressure"]  # xarray, with units; h5py and ParaView read the files too
open_run("out").scene["contact"]
