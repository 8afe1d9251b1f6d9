"""Methods of identification, one file each: from the measurements of a data set to its modes.

A method is a function ``identify(data, band, ...)`` that returns an
`modefront.identification.record.Identification`; ``data`` are what its kind of test measures.

===========  =====================================================  ============================
method       data                                                   source
===========  =====================================================  ============================
`hammer`     `modefront.data.responses.FrequencyResponses`          `modefront.identification`
`ambient`    `modefront.data.modal_test.Records` of all setups      Au 2011, Au & Zhang 2012
===========  =====================================================  ============================
"""
