from signkin.job import job

with job(snakemake):
    from signkin.binning.compiled import compile_kernels

    compile_kernels()
