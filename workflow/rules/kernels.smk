# The kernels of Bayesian binning, compiled before jobs run side by side.


rule compile_kernels:
    """Compiled code of the binning engine, once for all jobs."""
    output:
        touch("<results>/endres2013/kernels.done"),
    log:
        "<logs>/endres2013/kernels.log",
    priority: LONGEST_CHAIN
    params:
        code=PLAN.digest("stages/compile_kernels.py"),
    script:
        "../scripts/stages/compile_kernels.py"
