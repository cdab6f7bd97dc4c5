// A page that is live: the server tells when the run has gone on, and the page asks for its content.
