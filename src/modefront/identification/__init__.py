"""From measured vibrations to modes, with their standard deviations.

=====================  ================================================================
step                   module
=====================  ================================================================
functions as arrays    `modefront.data.responses`; from impacts: `modefront.data.impact`
variance of the data   `noise`
poles of all orders    `lscf`
clusters of poles      `stabilisation`
maximum likelihood     `modal_model`
modes that data need   `selection`
standard deviations    `statistics`, `shapes`
one data set           `methods`, a file a method; `record` is what they return
several sets, setups   `sets`
ambient records        `spectra`, `spectral_density`
=====================  ================================================================
"""
